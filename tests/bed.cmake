# Tests of contact and bed.
house_test(contact_test unit SOURCES unit/contact_test.cpp LIBRARIES qdem::contact OpenMP::OpenMP_CXX)
