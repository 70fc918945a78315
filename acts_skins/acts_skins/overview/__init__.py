"""All skins together: their frames, and an aggregate of their diagnostics."""
