"""`acts bench skins`: several skins on one machine, from their boards to a subscriber of their contacts."""
