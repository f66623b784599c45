# Tests of bed.
