"""Touch of a bag as tables: frames, contacts and joints that belong together, in formats that those who learn use."""
