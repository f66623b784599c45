# Tests of fem.
house_test(fem_contact unit SOURCES unit/fem_contact.cpp LIBRARIES fem::solid)
house_test(fem_profile_test unit SOURCES unit/fem_profile.cpp LIBRARIES fem::profile)
house_test(fem_cholesky unit SOURCES unit/fem_cholesky.cpp LIBRARIES fem::linear)
house_test(fem_interface_operator unit SOURCES unit/fem_interface_operator.cpp
           LIBRARIES fem::solid fem::beam_rail)
house_test(fem_patch_normal verification SOURCES verification/fem_patch_normal.cpp LIBRARIES fem::patch)
house_test(fem_patch_rolling verification SOURCES verification/fem_patch_rolling.cpp LIBRARIES fem::patch)
house_test(fem_patch_wheel verification SOURCES verification/fem_patch_wheel.cpp LIBRARIES fem::beam_rail)
house_test(fem_block_contact verification SOURCES verification/fem_block_contact.cpp LIBRARIES fem::blocks)
house_test(fem_elasticity verification SOURCES verification/fem_elasticity.cpp LIBRARIES fem::solid)
house_test(fem_static_beam verification SOURCES verification/fem_static_beam.cpp LIBRARIES fem::solid)
house_test(fem_wheel verification SOURCES verification/fem_wheel.cpp LIBRARIES fem::solid)
house_test(fem_window verification SOURCES verification/fem_window.cpp LIBRARIES fem::solid fem::beam_rail)
house_test(fem_newmark convergence SOURCES convergence/fem_newmark.cpp LIBRARIES fem::solid fem::beam_rail)
house_test(fem_participant_window integration SOURCES integration/fem_participant.cpp
           LIBRARIES fem::participant_openmpi fem::solid fem::beam_rail)
house_test(fem_beam_test verification SOURCES verification/fem_beam.cpp LIBRARIES fem::beam_rail)
house_test(fem_rail_ends verification SOURCES verification/fem_rail_ends.cpp LIBRARIES fem::solid fem::beam_rail)
house_test(fem_wheel_surfaces unit SOURCES unit/fem_wheel_surfaces.cpp LIBRARIES fem::beam_rail)
house_test(fem_solid_wheel verification SOURCES verification/fem_solid_wheel.cpp LIBRARIES fem::solid fem::beam_rail)
house_test(fem_support_pads verification SOURCES verification/fem_support_pads.cpp LIBRARIES fem::solid fem::beam_rail)
house_test(fem_solid_and_beam verification SOURCES verification/fem_solid_and_beam.cpp
           LIBRARIES proto::result_serial nlohmann_json::nlohmann_json)
add_dependencies(fem_solid_and_beam coupler oscillator_participant fem_solver fem_beam)
house_test(fem_contact_tool integration SOURCES integration/fem_contact_tool.cpp LIBRARIES proto::result_serial)
add_dependencies(fem_contact_tool fem_solver fem_beam)
house_test(fem_patch_record integration SOURCES integration/fem_patch_record.cpp
           LIBRARIES fem::participant_serial fem::beam_rail)
