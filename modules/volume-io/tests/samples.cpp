#include "samples.h"

#include "gzip_writer.h"

namespace isolux::test {

std::string gzipped(const std::string& bytes) {
  std::ostringstream out;
  detail::GzipWriter writer(out);
  writer.write(std::as_bytes(std::span(bytes)));
  writer.finish();
  return out.str();
}

}  // namespace isolux::test
