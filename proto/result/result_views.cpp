// result_views FILE.h5...: writes the ParaView 5.11 sidecar anew, for instance after a run was killed.
#include <cstdio>
#include <exception>

#include "proto/error.hpp"
#include "proto/result/xdmf.hpp"

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fputs("usage: result_views FILE.h5...  writes FILE.xdmf and FILE.views.h5 beside each file\n", stderr);
    return static_cast<int>(proto::ExitCode::usage);
  }
  try {
    for (int i = 1; i < argc; ++i) std::printf("%s\n", proto::write_xdmf(argv[i]).c_str());
  } catch (const proto::Error& error) {
    std::fprintf(stderr, "result_views: %s\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "result_views: %s\n", error.what());
    return static_cast<int>(proto::ExitCode::io_error);
  }
  return 0;
}
