#include "samples.h"

#include "gzip_writer.h"

#include <zlib.h>

namespace isolux::test {

std::string gzipped(const std::string& bytes) {
  std::ostringstream out;
  detail::GzipWriter writer(out);
  writer.write(std::as_bytes(std::span(bytes)));
  writer.finish();
  return out.str();
}

namespace {

std::string base64(const std::string& bytes) {
  static const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < 3; ++i) bits = (bits << 8) | (at + i < bytes.size() ? std::uint8_t(bytes[at + i]) : 0u);
    for (std::size_t i = 0; i < 4; ++i) text += at + i > bytes.size() ? '=' : letters[(bits >> (18 - 6 * i)) & 63u];
  }
  return text;
}

std::string zlib_of(const std::string& bytes) {
  uLongf size = compressBound(uLong(bytes.size()));
  std::string block(size, '\0');
  EXPECT_EQ(compress(reinterpret_cast<Bytef*>(block.data()), &size, reinterpret_cast<const Bytef*>(bytes.data()),
                     uLong(bytes.size())),
            Z_OK);
  block.resize(size);
  return block;
}

}  // namespace

std::string vti_coded(const std::string& data, const VtiCode& code) {
  const auto number = [&](std::size_t value) {
    return code.wide ? bytes_of<std::uint64_t>({value}, code.big_endian)
                     : bytes_of<std::uint32_t>({std::uint32_t(value)}, code.big_endian);
  };
  if (code.block == 0) return code.base64 ? base64(number(data.size()) + data) : number(data.size()) + data;
  std::string sizes;
  std::string blocks;
  std::size_t count = 0;
  for (std::size_t at = 0; at < data.size(); at += code.block, ++count) {
    const std::string block = zlib_of(data.substr(at, code.block));
    sizes += number(block.size());
    blocks += block;
  }
  const std::string header = number(count) + number(code.block) + number(data.size() % code.block) + sizes;
  return code.base64 ? base64(header) + base64(blocks) : header + blocks;
}

std::string vtk_arrays_sample(bool text) {
  const auto numbers = [&](int count) {
    std::string words;
    for (const auto value : ramp(count)) words += fmt::format("{} ", value);
    return (text ? words : bytes_of(ramp(count), true)) + "\n";
  };
  return std::string("# vtk DataFile Version 5.1\ntitle\n") + (text ? "ASCII" : "BINARY") +
         "\nDATASET STRUCTURED_POINTS\nFIELD FieldData 1\nnotes 1 2 string\n" +
         (text ? "a%20b\nc\n" : std::string("\xC3") + "a b\xC1" + "c\n") +
         "DIMENSIONS 3 2 2\nSPACING 0.5 2 4\nORIGIN 10 20 30\nCELL_DATA 2\nSCALARS c short\nLOOKUP_TABLE default\n" +
         numbers(2) + "POINT_DATA 12\nVECTORS v short\n" + numbers(36) +
         "METADATA\nCOMPONENT_NAMES\nx\n\nz\n\nFIELD FieldData 1\nf 2 12 short\n" + numbers(24) +
         "SCALARS s short\nLOOKUP_TABLE t\n" + numbers(12);
}

}  // namespace isolux::test
