# Tests of qdem.
house_test(qdem_elements verification SOURCES verification/qdem_elements.cpp LIBRARIES qdem::engine)
