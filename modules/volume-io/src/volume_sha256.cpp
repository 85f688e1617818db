#include <fmt/format.h>
#include <isolux/core/error.h>
#include <isolux/volume_io/read.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>

namespace isolux {

static_assert(std::endian::native == std::endian::little, "the hash is defined over little-endian bytes");

std::string volume_sha256(const VolumeView& volume) {
  const std::unique_ptr<EVP_MD_CTX, decltype(&EVP_MD_CTX_free)> context(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  const auto require = [](bool good) {
    if (!good) throw Error("libcrypto could not compute a SHA-256");
  };
  require(context != nullptr && EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) == 1);
  const auto add = [&](const void* data, std::size_t bytes) {
    require(EVP_DigestUpdate(context.get(), data, bytes) == 1);
  };
  const Lattice& lattice = volume.lattice();
  for (int a = 0; a < 3; ++a) {
    const std::int64_t size = lattice.size[a];
    add(&size, sizeof size);
  }
  // Adding 0.0 makes one zero of the two, which no reader of the frame can tell apart.
  const auto add_vector = [&](const Vec3& vector) {
    const std::array<double, 3> numbers = {vector.x + 0.0, vector.y + 0.0, vector.z + 0.0};
    add(numbers.data(), sizeof numbers);
  };
  add_vector(lattice.frame.origin);
  for (int a = 0; a < 3; ++a) add_vector(lattice.frame.axes[a]);
  if (const auto* floats = std::get_if<std::span<const float>>(&volume.voxels())) {
    add(floats->data(), floats->size_bytes());
  } else {
    std::array<float, 4096> part{};
    const std::size_t count = lattice.count();
    for (std::size_t begin = 0; begin < count; begin += part.size()) {
      const auto values = std::span(part).first(std::min(part.size(), count - begin));
      volume.copy(begin, values);
      add(values.data(), values.size_bytes());
    }
  }
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned length = 0;
  require(EVP_DigestFinal_ex(context.get(), digest.data(), &length) == 1);
  std::string text;
  for (unsigned i = 0; i < length; ++i) text += fmt::format("{:02x}", digest.at(i));
  return text;
}

}  // namespace isolux
