"""`acts diagnostics`: what the nodes say of themselves."""
