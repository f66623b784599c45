# Tests of qdem.
