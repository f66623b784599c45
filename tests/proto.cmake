# Tests of proto/: case reader, pad law, wire, session.
house_test(case_file_test unit SOURCES unit/case_file.cpp unit/case_sections.cpp LIBRARIES proto::case)
house_test(pad_law_test unit SOURCES unit/pad_law.cpp LIBRARIES proto::case)
house_test(wire_test unit SOURCES unit/wire.cpp LIBRARIES proto::wire)
house_test(golden_frame_test contract SOURCES contract/golden_frame.cpp LIBRARIES proto::wire)
house_test(session_test integration ALONE SOURCES integration/session.cpp integration/session_door.cpp
           integration/session_wire_faults.cpp
           LIBRARIES proto::participant proto::coupler_endpoint PkgConfig::zmq)
