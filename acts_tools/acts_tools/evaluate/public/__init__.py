"""Readers of public recordings in their original formats."""
