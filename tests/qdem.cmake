# Tests of qdem.
house_test(qdem_bodies unit SOURCES unit/qdem_model.cpp LIBRARIES qdem::engine)
house_test(qdem_kernels unit SOURCES unit/qdem_kernels.cpp LIBRARIES qdem::engine)
house_test(qdem_elements verification SOURCES verification/qdem_elements.cpp LIBRARIES qdem::engine)
house_test(qdem_bonds verification SOURCES verification/qdem_bonds.cpp LIBRARIES qdem::engine)
house_test(qdem_time_step convergence SOURCES convergence/qdem_time_step.cpp LIBRARIES qdem::engine)
house_test(qdem_vibration verification SOURCES verification/qdem_vibration.cpp LIBRARIES qdem::engine)
house_test(qdem_bending verification SOURCES verification/qdem_bending.cpp LIBRARIES qdem::engine)
house_test(qdem_modes verification SOURCES verification/qdem_modes.cpp LIBRARIES qdem::engine)
house_test(qdem_viscoelastic verification SOURCES verification/qdem_viscoelastic.cpp LIBRARIES qdem::engine)
house_test(qdem_engine_whole integration SOURCES integration/qdem_engine.cpp LIBRARIES qdem::engine)
house_test(qdem_device integration SOURCES integration/qdem_device.cpp unit/device_memory.cpp LIBRARIES qdem::engine)
set_source_files_properties(unit/device_memory.cpp PROPERTIES COMPILE_OPTIONS -fno-sanitize=null)  # Thrust
set_tests_properties(qdem_device PROPERTIES ENVIRONMENT "OMP_NUM_THREADS=1;GTEST_FILTER=-*/cuda")
add_test(NAME qdem_device_cuda COMMAND qdem_device --gtest_filter=*/cuda)
set_tests_properties(qdem_device_cuda PROPERTIES LABELS integration SKIP_REGULAR_EXPRESSION "NOT RUN"
                     ENVIRONMENT OMP_NUM_THREADS=1)
house_test(qdem_incline verification SOURCES verification/qdem_incline.cpp LIBRARIES qdem::engine)
house_test(qdem_relaxation verification SOURCES verification/qdem_relaxation.cpp LIBRARIES qdem::engine)
# Threads that wait by spinning stand in each other's way where other tests run at the same time.
set_tests_properties(qdem_engine_whole PROPERTIES ENVIRONMENT "OMP_NUM_THREADS=1;OMP_WAIT_POLICY=passive")
house_test(qdem_sensors_test unit SOURCES unit/qdem_sensors.cpp LIBRARIES qdem::participant)
house_test(qdem_case unit SOURCES unit/qdem_case.cpp LIBRARIES qdem::participant)
house_test(qdem_participant_whole integration SOURCES integration/qdem_participant.cpp
           LIBRARIES qdem::participant coupler::mapping)
set_tests_properties(qdem_participant_whole PROPERTIES ENVIRONMENT "OMP_NUM_THREADS=1;OMP_WAIT_POLICY=passive")
house_test(qdem_ledger verification SOURCES verification/qdem_ledger.cpp LIBRARIES qdem::engine)
house_test(qdem_absorbing verification SOURCES verification/qdem_absorbing.cpp LIBRARIES qdem::engine)
house_test(qdem_loads verification SOURCES verification/qdem_loads.cpp LIBRARIES qdem::engine)
