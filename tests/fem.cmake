# Tests of fem.
