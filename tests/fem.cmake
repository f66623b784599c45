# Tests of fem.
house_test(fem_static_beam verification SOURCES verification/fem_static_beam.cpp LIBRARIES fem::track)
