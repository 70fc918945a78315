"""`acts diagnostics`: print the diagnostics of the running nodes."""
