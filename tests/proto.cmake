# Tests of proto/: case reader, pad law, wire, session.
house_test(case_file_test unit SOURCES unit/case_file.cpp unit/case_sections.cpp LIBRARIES proto::case)
house_test(pad_law_test unit SOURCES unit/pad_law.cpp LIBRARIES proto::case)
house_test(wire_test unit SOURCES unit/wire.cpp LIBRARIES proto::wire)
house_test(golden_frame_test contract SOURCES contract/golden_frame.cpp LIBRARIES proto::wire)
# By hand, with clang: the decoder under libFuzzer. Its sources are compiled once more, to be watched.
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  set(wire ${PROJECT_SOURCE_DIR}/proto/wire)
  add_executable(decoder_fuzzer EXCLUDE_FROM_ALL fault/decoder_fuzzer.cpp ${PROJECT_SOURCE_DIR}/proto/error.cpp
                 ${wire}/messages.cpp ${wire}/frame.cpp ${wire}/encode.cpp ${wire}/decode.cpp)
  target_include_directories(decoder_fuzzer PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_BINARY_DIR}/proto/generated)
  target_link_libraries(decoder_fuzzer PRIVATE PkgConfig::flatbuffers PkgConfig::xxhash)
  target_compile_options(decoder_fuzzer PRIVATE -fsanitize=fuzzer,address,undefined -fno-sanitize-recover=undefined)
  target_link_options(decoder_fuzzer PRIVATE -fsanitize=fuzzer,address,undefined)
  set_target_properties(decoder_fuzzer PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test_bin)
  add_dependencies(decoder_fuzzer proto_wire)
endif()
house_test(session_test integration ALONE SOURCES integration/session.cpp integration/session_door.cpp
           integration/session_wire_faults.cpp
           LIBRARIES proto::participant proto::coupler_endpoint PkgConfig::zmq)
