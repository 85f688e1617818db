#include "frames.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>
#include <cstring>
#include <utility>
#include <vector>

namespace isolux::detail {
namespace {

class FrameSource final : public ByteSource {
 public:
  FrameSource(std::unique_ptr<ByteSource> source, const Frames& frames, std::uint64_t values,
              std::size_t bytes_per_value)
      : source_(std::move(source)),
        runs_(values / frames.together),
        before_(frames.wanted * frames.together * bytes_per_value),
        together_(frames.together * bytes_per_value),
        after_((frames.count - 1 - frames.wanted) * frames.together * bytes_per_value),
        buffer_(1 << 16) {}

  std::size_t read(std::span<std::byte> into) override {
    std::size_t done = 0;
    while (done < into.size()) {
      if (left_ == 0 && runs_ == 0) return done + take(into.subspan(done));
      if (left_ == 0) {
        if (!pass(before_)) break;
        left_ = together_;
        --runs_;
      }
      const auto piece = std::size_t(std::min<std::uint64_t>(left_, into.size() - done));
      const std::size_t got = take(into.subspan(done, piece));
      done += got;
      left_ -= got;
      if (got < piece || (left_ == 0 && !pass(after_))) break;
    }
    return done;
  }

 private:
  [[nodiscard]] bool refill() {
    if (at_ < end_) return true;
    at_ = 0;
    end_ = source_->read(buffer_);
    return end_ > 0;
  }
  std::size_t take(std::span<std::byte> into) {
    std::size_t done = 0;
    while (done < into.size() && refill()) {
      const std::size_t piece = std::min(into.size() - done, end_ - at_);
      std::memcpy(into.data() + done, buffer_.data() + at_, piece);
      done += piece;
      at_ += piece;
    }
    return done;
  }
  bool pass(std::uint64_t count) {
    while (count > 0 && refill()) {
      const auto piece = std::min<std::uint64_t>(count, end_ - at_);
      count -= piece;
      at_ += std::size_t(piece);
    }
    return count == 0;
  }

  std::unique_ptr<ByteSource> source_;
  std::uint64_t runs_;  ///< of the volume's values that are not yet begun
  std::uint64_t before_;
  std::uint64_t together_;
  std::uint64_t after_;
  std::uint64_t left_ = 0;  ///< bytes until the next volume's
  std::vector<std::byte> buffer_;
  std::size_t at_ = 0;
  std::size_t end_ = 0;
};

}  // namespace

void FrameOptions::describe(OptionVisitor& option) {
  option("frame", frame,
         {.min = -1, .help = "which volume of a file of several, as of times or channels, from 0; -1: there is one"});
}

std::uint64_t wanted_frame(const std::string& path, const std::string& reader, int frame, std::uint64_t count,
                           const std::string& what) {
  if (frame < 0 && count > 1)
    throw InvalidInput(fmt::format("{}: {}: --set-reader {}.frame=K reads one as a volume, K from 0 to {}", path, what,
                                   reader, count - 1));
  if (frame >= 0 && std::uint64_t(frame) >= count)
    throw InvalidInput(fmt::format("{}: {}.frame={}: allowed is 0 to {}, as many volumes has the file", path, reader,
                                   frame, count - 1));
  return std::uint64_t(std::max(frame, 0));
}

std::unique_ptr<ByteSource> frame_source(std::unique_ptr<ByteSource> source, const Frames& frames, std::uint64_t values,
                                         std::size_t bytes_per_value) {
  return std::make_unique<FrameSource>(std::move(source), frames, values, bytes_per_value);
}

}  // namespace isolux::detail
