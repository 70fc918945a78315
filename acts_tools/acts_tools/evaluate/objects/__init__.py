"""Evaluation of classification: the paper's and ours on the same presses."""
