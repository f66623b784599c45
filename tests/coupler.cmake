# Tests of coupler.
house_test(coupler_scheme_test unit SOURCES unit/coupler_scheme.cpp LIBRARIES coupler::scheme)
house_test(coupler_interface_check_test unit SOURCES unit/coupler_interface_check.cpp LIBRARIES coupler::mapping)
house_test(coupler_launch_test integration SOURCES integration/coupler_launch.cpp LIBRARIES coupler::launch TIMEOUT 60)
add_dependencies(coupler_launch_test coupler)
