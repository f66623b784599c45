# Tests of coupler.
