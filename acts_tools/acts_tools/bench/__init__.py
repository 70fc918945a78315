"""Figures of the sensing end: `acts bench`. Every measurement is a module, listed in `acts_tools.bench.registry`."""
