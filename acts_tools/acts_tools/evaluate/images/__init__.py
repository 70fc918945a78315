"""Evaluation of recovery: recordings are sampled like a board, recovered by a method, and scored frame by frame."""
