"""What a hand does by itself when it is touched: behaviours that know joints and regions of skin, and nothing else."""
