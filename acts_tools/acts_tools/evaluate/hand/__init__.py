"""The reflexes of the simulated hand, scenario by scenario."""
