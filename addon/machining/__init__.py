"""Jobs: operations that machine a part from a stock, in order."""
