"""`acts listen`: measure loss and delay of topics on this machine."""
