"""Evaluation of slip detection, on recordings of full frames and on sampled frames."""
