// Result files that somebody else made: none leads the reader out of the file, or to memory that the file does not
// hold.
#include <gtest/gtest.h>
#include <hdf5.h>

#include <fstream>

#include "proto/error.hpp"
#include "proto/result/reader.hpp"
#include "tests/support/processes.hpp"

namespace {

/// A file made with HDF5 alone.
class ForeignFile : public ::testing::Test {
 protected:
  ForeignFile() : path_(folder_.file("foreign.h5")) {
    std::ofstream(secret()) << std::string(1024, 's');
    file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    put("/own", {16});
    hid_t other = H5Fcreate(other_file().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    std::swap(file_, other);
    put("/theirs", {16});
    H5Fclose(file_);
    file_ = other;
  }
  std::string secret() const { return folder_.file("secret"); }
  std::string other_file() const { return folder_.file("other.h5"); }

  void put(const std::string& name, std::vector<hsize_t> dims, hid_t properties = H5P_DEFAULT) {
    const hid_t space = H5Screate_simple(static_cast<int>(dims.size()), dims.data(), nullptr);
    const hid_t set = H5Dcreate2(file_, name.c_str(), H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    EXPECT_GE(set, 0) << name;
    if (properties == H5P_DEFAULT) {
      const std::vector<double> values(dims[0], 7.0);
      H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    }
    H5Dclose(set);
    H5Sclose(space);
  }

  /// What reading the object says; "" when it gives values.
  std::string told(const std::string& name) {
    H5Fflush(file_, H5F_SCOPE_GLOBAL);
    H5Fclose(file_);
    file_ = -1;
    try {
      const proto::ResultReader reader(path_);
      EXPECT_EQ(reader.read("/own").values, std::vector<double>(16, 7.0));
      reader.read(name);
      return {};
    } catch (const proto::Error& error) {
      EXPECT_EQ(error.code(), proto::ExitCode::bad_data);
      return error.what();
    }
  }

  tests::TemporaryFolder folder_;
  std::string path_;
  hid_t file_ = -1;
};

void expect_part(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos) << text;
}

TEST_F(ForeignFile, WithoutTricksIsRead) {
  EXPECT_EQ(told("/own"), "");
}

TEST_F(ForeignFile, ReadsNoOtherFileByExternalStorage) {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_external(properties, secret().c_str(), 0, 1024);
  put("/x", {128}, properties);
  expect_part(told("/x"), "its values lie in another file");
}

TEST_F(ForeignFile, ReadsNoOtherFileByAVirtualDataset) {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t n = 16;
  const hid_t space = H5Screate_simple(1, &n, nullptr);
  H5Pset_virtual(properties, space, other_file().c_str(), "/theirs", space);
  put("/x", {16}, properties);
  expect_part(told("/x"), "it shows a file of another folder");
}

TEST_F(ForeignFile, FollowsNoLinkOut) {
  H5Lcreate_external(other_file().c_str(), "/", file_, "out", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_external(other_file().c_str(), "/theirs", file_, "x", H5P_DEFAULT, H5P_DEFAULT);
  H5Lcreate_soft("/out/theirs", file_, "soft", H5P_DEFAULT, H5P_DEFAULT);
  H5Fflush(file_, H5F_SCOPE_GLOBAL);
  expect_part(told("/x"), "a link to somewhere else");
  const proto::ResultReader reader(path_);
  for (const char* name : {"/x", "/soft", "/out/theirs"}) {
    EXPECT_FALSE(reader.has(name)) << name;
    EXPECT_THROW(reader.read(name), proto::Error) << name;
  }
  EXPECT_THROW(reader.members("/out"), proto::Error);
}

TEST_F(ForeignFile, ReservesNoMemoryForWhatIsNotThere) {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk = 1024;
  H5Pset_chunk(properties, 1, &chunk);
  H5Pset_deflate(properties, 9);
  put("/x", {hsize_t{1} << 32}, properties);
  expect_part(told("/x"), "it claims more values than the file can hold");
}

TEST_F(ForeignFile, ReservesNoMemoryForSizesThatOverflow) {
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  const hsize_t chunk[] = {1, 1, 1};
  H5Pset_chunk(properties, 3, chunk);
  const hsize_t n = hsize_t{1} << 31;
  put("/x", {n, n, 8}, properties);
  expect_part(told("/x"), "no memory holds the dataset");
}

}  // namespace
