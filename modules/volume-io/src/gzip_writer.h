#pragma once

#include <cstddef>
#include <memory>
#include <ostream>
#include <span>

namespace isolux::detail {

/// Compresses to a gzip stream without a time or a name in it: the same bytes in, the same bytes out.
class GzipWriter {
 public:
  explicit GzipWriter(std::ostream& out);
  ~GzipWriter();
  GzipWriter(const GzipWriter&) = delete;
  GzipWriter& operator=(const GzipWriter&) = delete;

  void write(std::span<const std::byte> bytes);
  /// Ends the stream; nothing may be written behind.
  void finish();

 private:
  struct State;
  void run(int flush);

  std::ostream& out_;
  std::unique_ptr<State> state_;
};

}  // namespace isolux::detail
