"""What every executable begins with: signals, then imports, then nodes."""
