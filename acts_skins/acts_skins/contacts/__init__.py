"""The contacts of all skins in one frame and one message."""
