"""`acts driver`: what a running driver says, and what it is asked to do."""
