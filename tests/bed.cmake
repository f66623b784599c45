# Tests of contact and bed.
house_test(contact_test unit SOURCES unit/contact_test.cpp LIBRARIES qdem::contact OpenMP::OpenMP_CXX)
house_test(contact_calibration unit SOURCES unit/contact_calibration.cpp LIBRARIES qdem::contact)
house_test(bed_test unit SOURCES unit/bed_test.cpp LIBRARIES qdem::bed)
house_test(stone_files_test unit SOURCES unit/stone_files_test.cpp LIBRARIES qdem::bed)
house_test(bed_rest_test verification ALONE TIMEOUT 900 SOURCES verification/bed_rest_test.cpp LIBRARIES qdem::bed qdem::engine)
house_test(contact_impact_test verification SOURCES verification/contact_impact_test.cpp LIBRARIES qdem::engine)
