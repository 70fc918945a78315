"""For every test: a loaded machine is slow, which is no failure; and signals do what they do in a terminal."""

import signal

from hypothesis import HealthCheck, settings

settings.register_profile("acts", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("acts")

# In the background, or under nohup, these are ignored, and the processes that tests send them to would inherit that.
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)
