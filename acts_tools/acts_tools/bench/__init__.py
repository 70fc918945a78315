"""`acts bench`: performance of the sensing. Every measurement is a module, listed in `acts_tools.bench.registry`."""
