"""How well objects are told apart: the paper's classification and ours on the same presses."""
