"""A simulated hand that runs from its launch file: commanded, observed and recorded."""
