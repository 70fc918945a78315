"""`acts evaluate`: score recovery, classification, slip and reflexes on recorded or simulated touch."""
