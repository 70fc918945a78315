"""The measurements of `acts bench`, one module each, listed in `acts_tools.bench.registry`."""
