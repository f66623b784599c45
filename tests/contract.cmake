# Contracts of the tree itself: include rules, text, documented schema, shipped cases. Each check has its control.
set(contract ${CMAKE_CURRENT_SOURCE_DIR}/contract)
function(contract_test name)
  add_test(NAME contract_${name} COMMAND ${ARGN})
  set_tests_properties(contract_${name} PROPERTIES LABELS contract TIMEOUT 60)
endfunction()
contract_test(include_rules bash ${contract}/include_rules.sh ${PROJECT_SOURCE_DIR})
contract_test(include_rules_control bash ${contract}/include_rules_control.sh)
contract_test(text_hygiene bash ${contract}/text_hygiene.sh ${PROJECT_SOURCE_DIR})
contract_test(text_hygiene_control bash ${contract}/text_hygiene_control.sh)
contract_test(schema_documented bash ${contract}/schema_documented.sh ${PROJECT_SOURCE_DIR}/proto/schema/coupling.fbs
              ${PROJECT_SOURCE_DIR}/proto/README.md)
contract_test(schema_documented_control bash ${contract}/schema_documented_control.sh
              ${PROJECT_SOURCE_DIR}/proto/schema/coupling.fbs)
contract_test(device_dereference bash ${contract}/device_dereference.sh ${PROJECT_SOURCE_DIR})
add_test(NAME contract_cuda_build COMMAND bash ${contract}/cuda_build.sh ${PROJECT_SOURCE_DIR}
         "$<TARGET_FILE:qdem_engine>;$<TARGET_FILE:qdem_contact>;$<TARGET_FILE:qdem_model>;$<TARGET_FILE:proto_case>"
         ${PROJECT_BINARY_DIR}/cuda_build /usr/include/eigen3)
set_tests_properties(contract_cuda_build PROPERTIES LABELS contract TIMEOUT 600 SKIP_RETURN_CODE 77)
if(TARGET coupler AND TARGET qdem_solver AND TARGET fem_solver)
  add_test(NAME contract_case_schema COMMAND /usr/bin/python3 ${contract}/case_schema.py $<TARGET_FILE:coupler>
           ${PROJECT_SOURCE_DIR})
  set_tests_properties(contract_case_schema PROPERTIES LABELS contract TIMEOUT 60 SKIP_RETURN_CODE 77)
  contract_test(cases_accepted bash ${contract}/cases_accepted.sh $<TARGET_FILE:coupler> ${PROJECT_SOURCE_DIR})
endif()
