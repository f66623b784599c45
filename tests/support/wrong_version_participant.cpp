// A participant that speaks the protocol's next major version: the coupler must turn it away.
#include <cstdio>
#include <string>

#include "proto/case/case_file.hpp"
#include "proto/session/connection.hpp"
#include "proto/wire/codec.hpp"

int main(int argc, char** argv) {
  std::string case_path, endpoint, name;
  for (int i = 1; i + 1 < argc; ++i) {
    if (argv[i] == std::string("--case")) case_path = argv[i + 1];
    if (argv[i] == std::string("--endpoint")) endpoint = argv[i + 1];
    if (argv[i] == std::string("--name")) name = argv[i + 1];
  }
  try {
    const auto options = proto::read_session_options(endpoint, proto::CaseFile::load(case_path).hash());
    proto::Progress progress;
    proto::Connection connection(options, progress);
    proto::Hello hello;
    hello.name = name;
    hello.protocol_major = proto::protocol_major + 1;
    hello.protocol_minor = proto::protocol_minor;
    hello.schema_hash = proto::schema_hash();
    hello.case_hash = options.case_hash;
    hello.session_token = options.session_token;
    connection.send(hello);
    connection.receive();
    return 0;
  } catch (const proto::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}
