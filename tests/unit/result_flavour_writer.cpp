// Writes the sample file under the given name; built once with each flavour of HDF5.
#include "tests/support/result_samples.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  auto file = proto::FieldSeriesFile::create(argv[1], tests::sample_fields(50));
  for (std::size_t step = 0; step < 20; ++step) tests::write_sample_step(file, step, 50);
  file.close();
  return 0;
}
