"""The evaluated methods, with one interface, and their dictionaries."""
