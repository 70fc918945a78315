"""What ACTS is compared with: the same work done by plain code, by other libraries, and by bare arithmetic."""
