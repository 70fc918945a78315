"""How what touches a patch of skin moves along it, and whether it slips."""
