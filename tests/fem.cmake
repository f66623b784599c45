# Tests of fem.
house_test(fem_contact unit SOURCES unit/fem_contact.cpp LIBRARIES fem::track)
house_test(fem_interface_operator unit SOURCES unit/fem_interface_operator.cpp LIBRARIES fem::track)
house_test(fem_elasticity verification SOURCES verification/fem_elasticity.cpp LIBRARIES fem::track)
house_test(fem_static_beam verification SOURCES verification/fem_static_beam.cpp LIBRARIES fem::track)
house_test(fem_wheel verification SOURCES verification/fem_wheel.cpp LIBRARIES fem::track)
house_test(fem_window verification SOURCES verification/fem_window.cpp LIBRARIES fem::track)
house_test(fem_newmark convergence SOURCES convergence/fem_newmark.cpp LIBRARIES fem::track)
house_test(fem_participant_window integration SOURCES integration/fem_participant.cpp LIBRARIES fem::participant)
