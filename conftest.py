"""For every test: a loaded machine is slow, which is no failure."""

from hypothesis import HealthCheck, settings

settings.register_profile("acts", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("acts")
