# Tests of qdem.
house_test(qdem_bodies unit SOURCES unit/qdem_model.cpp LIBRARIES qdem::engine)
house_test(qdem_elements verification SOURCES verification/qdem_elements.cpp LIBRARIES qdem::engine)
house_test(qdem_time_step convergence SOURCES convergence/qdem_time_step.cpp LIBRARIES qdem::engine)
house_test(qdem_vibration verification SOURCES verification/qdem_vibration.cpp LIBRARIES qdem::engine)
house_test(qdem_engine_whole integration SOURCES integration/qdem_engine.cpp LIBRARIES qdem::engine)
