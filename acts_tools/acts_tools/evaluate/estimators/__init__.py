"""The methods that are evaluated, behind one interface, and the dictionaries that they are given."""
