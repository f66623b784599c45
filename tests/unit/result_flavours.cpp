// The serial and the openmpi flavour of HDF5 write the same file.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>

#include "tests/support/result_samples.hpp"

namespace {

std::string bytes_of(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(ResultFlavours, WriteEqualFiles) {
  const tests::TemporaryFolder folder;
  const std::string serial = folder.file("serial.h5"), openmpi = folder.file("openmpi.h5");
  ASSERT_EQ(std::system(("\"" RESULT_WRITER_SERIAL "\" " + serial).c_str()), 0);
  ASSERT_EQ(std::system(("\"" RESULT_WRITER_OPENMPI "\" " + openmpi).c_str()), 0);
  EXPECT_GT(bytes_of(serial).size(), 100000u);
  EXPECT_TRUE(bytes_of(serial) == bytes_of(openmpi));
}

}  // namespace
