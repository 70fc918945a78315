"""`acts listen`: what of a topic arrives here, and how late."""
