"""Programs of plans, files and cuts: written as NC code, simulated, verified."""
