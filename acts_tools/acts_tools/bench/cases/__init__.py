"""The measurements of `acts bench`, a module each, listed in `acts_tools.bench.registry`."""
