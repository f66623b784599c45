# Tests of coupler.
house_test(coupler_scheme_test unit SOURCES unit/coupler_scheme.cpp LIBRARIES coupler::advisor)
house_test(coupler_implicit_test unit SOURCES unit/coupler_implicit.cpp LIBRARIES coupler::advisor)
house_test(coupler_joint_test unit SOURCES unit/coupler_joint.cpp LIBRARIES coupler::advisor)
house_test(coupler_audit_test unit SOURCES unit/coupler_audit.cpp LIBRARIES coupler::scheme)
house_test(coupler_split_bar_test verification SOURCES verification/coupler_split_bar.cpp LIBRARIES coupler::advisor)
house_test(coupler_advisor_test verification SOURCES verification/coupler_advisor.cpp LIBRARIES coupler::advisor)
house_test(coupler_interface_check_test unit SOURCES unit/coupler_interface_check.cpp LIBRARIES coupler::mapping)
house_test(coupler_mapping_test unit SOURCES unit/coupler_mapping.cpp LIBRARIES coupler::mapping)
house_test(coupler_launch_test integration SOURCES integration/coupler_launch.cpp LIBRARIES coupler::launch TIMEOUT 60)
add_dependencies(coupler_launch_test coupler)
find_package(nlohmann_json 3.11 REQUIRED)
house_test(coupler_split_oscillator_test convergence SOURCES convergence/coupler_split_oscillator.cpp
           LIBRARIES coupler::advisor nlohmann_json::nlohmann_json)
add_dependencies(coupler_split_oscillator_test coupler oscillator_participant)
add_executable(linear_participant support/linear_participant.cpp)
target_link_libraries(linear_participant PRIVATE proto::participant coupler::scheme house::options)
set_target_properties(linear_participant PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test_bin)
house_test(coupler_test_problems_test convergence SOURCES convergence/coupler_test_problems.cpp
           LIBRARIES coupler::mapping proto::result_serial nlohmann_json::nlohmann_json)
add_dependencies(coupler_test_problems_test coupler linear_participant)
add_executable(wrong_version_participant support/wrong_version_participant.cpp)
target_link_libraries(wrong_version_participant PRIVATE proto::participant proto_session_sockets house::options)
set_target_properties(wrong_version_participant PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test_bin)
house_test(coupler_faults_test fault SOURCES fault/coupler_faults.cpp
           LIBRARIES proto::result_serial nlohmann_json::nlohmann_json TIMEOUT 240)
add_dependencies(coupler_faults_test coupler oscillator_participant relaxing_participant wrong_version_participant)
add_executable(relaxing_participant support/relaxing_participant.cpp)
target_link_libraries(relaxing_participant PRIVATE proto::participant coupler::advisor house::options)
set_target_properties(relaxing_participant PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test_bin)
house_test(coupler_initialise_test integration SOURCES integration/coupler_initialise.cpp
           LIBRARIES proto::result_serial nlohmann_json::nlohmann_json TIMEOUT 60)
add_dependencies(coupler_initialise_test coupler relaxing_participant)
# A participant in Python that knows proto/README.md and the schema, nothing else of this tree.
set(spring_rail ${PROJECT_BINARY_DIR}/test_bin/spring_rail)
add_custom_command(
  OUTPUT ${spring_rail}/spring_rail.py ${spring_rail}/coupling.fbs ${spring_rail}/proto/fbs/Message.py
  COMMAND ${FLATC} --python -o ${spring_rail} ${PROJECT_SOURCE_DIR}/proto/schema/coupling.fbs
  COMMAND ${CMAKE_COMMAND} -E copy ${PROJECT_SOURCE_DIR}/proto/schema/coupling.fbs
          ${PROJECT_SOURCE_DIR}/tests/support/spring_rail.py ${spring_rail}
  DEPENDS ${PROJECT_SOURCE_DIR}/proto/schema/coupling.fbs support/spring_rail.py
  VERBATIM)
add_custom_target(spring_rail_participant DEPENDS ${spring_rail}/spring_rail.py)
house_test(python_participant_test integration SOURCES integration/python_participant.cpp
           LIBRARIES proto::case nlohmann_json::nlohmann_json TIMEOUT 120)
add_dependencies(python_participant_test coupler oscillator_participant spring_rail_participant)
house_test(coupler_schemes_run_test integration SOURCES integration/coupler_schemes_run.cpp
           LIBRARIES proto::result_serial nlohmann_json::nlohmann_json TIMEOUT 60)
add_dependencies(coupler_schemes_run_test coupler relaxing_participant oscillator_participant)
house_test(coupler_watch_test integration SOURCES integration/coupler_watch.cpp
           LIBRARIES proto::case nlohmann_json::nlohmann_json TIMEOUT 120)
add_dependencies(coupler_watch_test coupler oscillator_participant)
house_test(coupler_supervisor_test integration SOURCES integration/coupler_supervisor.cpp
           LIBRARIES coupler::supervise nlohmann_json::nlohmann_json TIMEOUT 60)
add_dependencies(coupler_supervisor_test coupler oscillator_participant)
house_test(coupler_convergence_test unit SOURCES unit/coupler_convergence.cpp LIBRARIES coupler::report)
house_test(coupler_record_test unit SOURCES unit/coupler_record.cpp
           LIBRARIES coupler::record nlohmann_json::nlohmann_json)

house_test(analysis_spectrum_test unit SOURCES unit/analysis_spectrum.cpp LIBRARIES coupler::analysis)
house_test(analysis_layer_test unit SOURCES unit/analysis_layer.cpp LIBRARIES coupler::analysis)
house_test(analysis_run_test integration SOURCES integration/analysis_run.cpp
           LIBRARIES coupler::study coupler::record qdem::participant TIMEOUT 120)
add_dependencies(analysis_run_test coupler)

house_test(report_page_test unit SOURCES unit/report_page.cpp LIBRARIES coupler::page)
find_program(NODE node)
house_test(run_pictures_test integration SOURCES integration/run_pictures.cpp
           LIBRARIES nlohmann_json::nlohmann_json TIMEOUT 300)
target_compile_definitions(run_pictures_test
                           PRIVATE HOUSE_NODE="${NODE}"
                                   HOUSE_REPORT_MODULES="${PROJECT_BINARY_DIR}/coupler/report_page/node_modules")
add_dependencies(run_pictures_test coupler qdem_solver fem_solver)
if(TARGET report_page)
  add_dependencies(run_pictures_test report_page)
endif()

house_test(coupler_solvers_test integration ALONE SOURCES integration/coupler_solvers.cpp
           LIBRARIES proto::case nlohmann_json::nlohmann_json)
add_dependencies(coupler_solvers_test coupler qdem_solver fem_solver)

# The whole chain; the first test builds the bed of the quick case.
house_test(wheel_passage_test integration ALONE SOURCES integration/wheel_passage.cpp
           LIBRARIES proto::result_serial nlohmann_json::nlohmann_json TIMEOUT 1500)
add_dependencies(wheel_passage_test coupler qdem_solver fem_solver)

# Faults of the real solvers, on a small bed that the first test builds.
house_test(solver_kills_test fault ALONE SOURCES fault/solver_kills.cpp
           LIBRARIES proto::result_serial nlohmann_json::nlohmann_json TIMEOUT 300)
house_test(solver_bad_input_test fault ALONE SOURCES fault/solver_bad_input.cpp
           LIBRARIES qdem::participant qdem::bed nlohmann_json::nlohmann_json TIMEOUT 300)
foreach(test solver_kills_test solver_bad_input_test)
  add_dependencies(${test} coupler qdem_solver fem_solver oscillator_participant)
endforeach()
house_test(coupler_resume_test fault ALONE SOURCES fault/coupler_resume.cpp
           LIBRARIES proto::result_serial nlohmann_json::nlohmann_json TIMEOUT 400)
add_dependencies(coupler_resume_test coupler qdem_solver fem_solver oscillator_participant)

house_test(coupler_surroundings_test fault SOURCES fault/coupler_surroundings.cpp
           LIBRARIES proto::case nlohmann_json::nlohmann_json)
add_dependencies(coupler_surroundings_test coupler oscillator_participant relaxing_participant)

# The same with the full counts; not in the default run: tests/run --label fault-long.
add_test(NAME coupler_kills_long_test COMMAND coupler_resume_test --gtest_filter=Resume.AfterKills*)
set_tests_properties(coupler_kills_long_test PROPERTIES ENVIRONMENT HOUSE_KILLS=300 TIMEOUT 7200)
add_test(NAME coupler_checkpoint_kills_long_test COMMAND coupler_surroundings_test --gtest_filter=CheckpointKill.*)
set_tests_properties(coupler_checkpoint_kills_long_test PROPERTIES ENVIRONMENT HOUSE_KILLS=500 TIMEOUT 7200)
set_tests_properties(coupler_kills_long_test coupler_checkpoint_kills_long_test PROPERTIES LABELS fault-long RUN_SERIAL
                                                                                           TRUE)

# What a participant has to keep, and participants that do not.
add_executable(broken_participant support/broken_participant.cpp)
target_link_libraries(broken_participant PRIVATE proto::participant proto_session_sockets proto::result_serial
                                                 coupler::advisor Threads::Threads house::options)
set_target_properties(broken_participant PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test_bin)
add_dependencies(coupler_resume_test broken_participant)
house_test(coupler_conformance_test fault ALONE SOURCES fault/coupler_conformance.cpp
           LIBRARIES proto::result_serial nlohmann_json::nlohmann_json TIMEOUT 600)
add_dependencies(coupler_conformance_test coupler oscillator_participant broken_participant qdem_solver fem_solver fem_beam
                 spring_rail_participant)
house_test(coupler_replay_test integration SOURCES integration/coupler_replay.cpp
           LIBRARIES proto::case nlohmann_json::nlohmann_json TIMEOUT 120)
add_dependencies(coupler_replay_test coupler oscillator_participant broken_participant)
# A measurement, run by hand: how fast a machine answers is not for the suite to judge.
add_executable(coupler_overhead EXCLUDE_FROM_ALL benchmark/coupler_overhead.cpp)
target_link_libraries(coupler_overhead PRIVATE proto::participant proto::coupler_endpoint house::options GTest::gtest_main)
target_include_directories(coupler_overhead PRIVATE ${PROJECT_SOURCE_DIR})
set_target_properties(coupler_overhead PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/test_bin)
