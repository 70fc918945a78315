"""Export a bag as tables of frames, contacts and joints at common times, in formats for machine learning."""
