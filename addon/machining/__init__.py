"""The job: operations that machine the part out of a stock, one after the other."""
