# Writes the schema's text as a C++ constant: cmake -D SCHEMA=in.fbs -D HEADER=out.hpp -P embed_schema.cmake
file(READ "${SCHEMA}" text)
file(WRITE "${HEADER}" "#pragma once\n\nnamespace proto {\n\ninline constexpr char schema_text[] = R\"schema(${text})schema\";\n\n}  // namespace proto\n")
