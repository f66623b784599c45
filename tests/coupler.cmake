# Tests of coupler.
house_test(coupler_scheme_test unit SOURCES unit/coupler_scheme.cpp LIBRARIES coupler::scheme)
house_test(coupler_interface_check_test unit SOURCES unit/coupler_interface_check.cpp LIBRARIES coupler::mapping)
