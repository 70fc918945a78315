"""What all ACTS nodes share: parameters, quality of service, executors, diagnostics, processes."""
