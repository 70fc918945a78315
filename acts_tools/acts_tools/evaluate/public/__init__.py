"""Recordings that others have published, in their own formats."""
