# Runs of the shipped cases that are short enough for the suite, judged by their expected values (cases/expected.py).
find_package(Python3 3.11 REQUIRED COMPONENTS Interpreter)
# case_test(NAME [TIMEOUT s]): the runs of cases/NAME/expected.toml that say by = ["suite"].
function(case_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "" ${ARGN})
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  add_test(NAME case_${name} COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/cases/study.py ${PROJECT_SOURCE_DIR}/cases/${name}
           --programs $<TARGET_FILE_DIR:coupler> --by suite)
  set_tests_properties(case_${name} PROPERTIES LABELS verification TIMEOUT ${ARG_TIMEOUT}
                       ENVIRONMENT "OMP_NUM_THREADS=1;QDEM_BED_CACHE=${PROJECT_BINARY_DIR}/test_beds")
endfunction()
if(TARGET coupler AND TARGET qdem_solver AND TARGET fem_solver)
  case_test(split_oscillator)
  case_test(stone_impulse)
  case_test(sleeper_impulse)
  case_test(drop_weight TIMEOUT 1500)
  case_test(qdem_vs_dem TIMEOUT 1500)
  case_test(dipped_joint TIMEOUT 1500)
  case_test(wheel_flat TIMEOUT 1500)
  set_tests_properties(case_drop_weight case_qdem_vs_dem case_dipped_joint case_wheel_flat PROPERTIES DEPENDS wheel_passage_test)  # it builds the bed they use
  contract_test(expected_values bash ${contract}/expected_values.sh ${PROJECT_SOURCE_DIR} $<TARGET_FILE_DIR:coupler>)
endif()
