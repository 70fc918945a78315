"""References to compare ACTS with: the same work in plain Python, in other libraries, and as bare arithmetic."""
