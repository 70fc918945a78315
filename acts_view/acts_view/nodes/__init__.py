"""The node `view` and the topics of a skin that it takes."""
