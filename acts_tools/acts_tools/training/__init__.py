"""Parts of `acts train`: sources of frames, and checkpoints."""
