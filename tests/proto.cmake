# Tests of proto/: case reader, wire, session.
house_test(session_test integration SOURCES integration/session_test.cpp
           LIBRARIES proto::participant proto::coupler_endpoint)
