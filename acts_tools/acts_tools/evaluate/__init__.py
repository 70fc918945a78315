"""`acts evaluate`: how well touch is recovered, on recorded or modelled frames."""
