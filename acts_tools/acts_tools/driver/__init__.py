"""`acts driver`: control a running driver, and read its status."""
