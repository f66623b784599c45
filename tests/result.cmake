# Tests of result.
house_test(result_round_trip unit SOURCES unit/result_round_trip.cpp LIBRARIES proto::result_serial)
house_test(result_states_test unit SOURCES unit/result_states.cpp LIBRARIES proto::result_serial)
house_test(result_writer_killed fault SOURCES fault/result_writer_killed.cpp LIBRARIES proto::result_serial)
house_test(result_disk_full fault SOURCES fault/result_disk_full.cpp LIBRARIES proto::result_serial)

house_test(result_foreign_test fault SOURCES fault/result_foreign.cpp
           LIBRARIES proto::result_serial PkgConfig::hdf5_serial)

house_test(result_flavours unit SOURCES unit/result_flavours.cpp)
foreach(flavour serial openmpi)
  add_executable(result_writer_${flavour} unit/result_flavour_writer.cpp)
  target_link_libraries(result_writer_${flavour} PRIVATE proto::result_${flavour} house::options)
  set_target_properties(result_writer_${flavour} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test_bin)
  string(TOUPPER ${flavour} upper)
  target_compile_definitions(result_flavours PRIVATE RESULT_WRITER_${upper}="$<TARGET_FILE:result_writer_${flavour}>")
  add_dependencies(result_flavours result_writer_${flavour})
endforeach()
