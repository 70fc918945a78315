"""What `acts train` is made of: where frames come from, checkpoints, and showing how far it is."""
