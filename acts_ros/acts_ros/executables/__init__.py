"""The start of every executable: signal handlers first, then imports, then nodes."""
