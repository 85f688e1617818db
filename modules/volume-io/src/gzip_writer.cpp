#include "gzip_writer.h"

#include <isolux/core/error.h>
#include <zlib.h>

#include <vector>

namespace isolux::detail {

struct GzipWriter::State {
  z_stream stream{};
  std::vector<Bytef> buffer = std::vector<Bytef>(1 << 16);
};

GzipWriter::GzipWriter(std::ostream& out) : out_(out), state_(std::make_unique<State>()) {
  // 15 bits of window, +16 for the gzip header.
  if (deflateInit2(&state_->stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
    throw Error("zlib could not start");
}

GzipWriter::~GzipWriter() { deflateEnd(&state_->stream); }

void GzipWriter::write(std::span<const std::byte> bytes) {
  state_->stream.next_in = reinterpret_cast<Bytef*>(const_cast<std::byte*>(bytes.data()));
  state_->stream.avail_in = uInt(bytes.size());
  run(Z_NO_FLUSH);
}

void GzipWriter::finish() { run(Z_FINISH); }

void GzipWriter::run(int flush) {
  z_stream& stream = state_->stream;
  do {
    stream.next_out = state_->buffer.data();
    stream.avail_out = uInt(state_->buffer.size());
    deflate(&stream, flush);
    out_.write(reinterpret_cast<const char*>(state_->buffer.data()),
               std::streamsize(state_->buffer.size() - stream.avail_out));
  } while (stream.avail_out == 0);
}

}  // namespace isolux::detail
