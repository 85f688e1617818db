#pragma once

#include "support.h"

#include <fmt/format.h>

#include <numeric>

/// Small valid files of each format, all holding the 3x2x2 voxels 0, 1, ... 11, for the tests to read and to spoil.
namespace isolux::test {

inline std::vector<std::int16_t> ramp(int count = 12, int first = 0) {
  std::vector<std::int16_t> values(std::size_t(count), 0);
  std::iota(values.begin(), values.end(), std::int16_t(first));
  return values;
}

/// NIfTI-1, int16, spacing 0.5 2 4, sform RAS: x to the left of -10, y, z.
inline std::string nifti_sample(bool big = false) {
  std::string bytes(352, '\0');
  put<std::int32_t>(bytes, 0, 348, big);
  const std::array<std::int16_t, 8> dim = {3, 3, 2, 2, 1, 1, 1, 1};
  const std::array<float, 8> pixdim = {1.0f, 0.5f, 2.0f, 4.0f, 0.0f, 0.0f, 0.0f, 0.0f};
  for (std::size_t i = 0; i < 8; ++i) {
    put<std::int16_t>(bytes, 40 + 2 * i, dim.at(i), big);
    put<float>(bytes, 76 + 4 * i, pixdim.at(i), big);
  }
  put<std::int16_t>(bytes, 70, 4, big);
  put<std::int16_t>(bytes, 72, 16, big);
  put<float>(bytes, 108, 352.0f, big);
  put<float>(bytes, 112, 1.0f, big);
  bytes[123] = 2;  // millimetres, and seconds left out
  put<std::int16_t>(bytes, 254, 1, big);
  const std::array<float, 12> sform = {0.5f, 0, 0, -10, 0, 2, 0, 20, 0, 0, 4, 30};
  for (std::size_t i = 0; i < 12; ++i) put<float>(bytes, 280 + 4 * i, sform.at(i), big);
  bytes.replace(344, 4, std::string("n+1\0", 4));
  return bytes + bytes_of(ramp(), big);
}

inline std::string meta_header(const std::string& data_file, const std::string& more = {}) {
  return "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n" + more +
         "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 10 20 30\nElementSpacing = 0.5 2 4\nDimSize = 3 2 2\n"
         "ElementType = MET_SHORT\nElementDataFile = " +
         data_file + "\n";
}

inline std::string npy_header(const std::string& descr, const std::string& shape, bool fortran_order = false,
                              int version = 1) {
  const std::string text = fmt::format("{{'descr': '{}', 'fortran_order': {}, 'shape': {}, }}\n", descr,
                                       fortran_order ? "True" : "False", shape);
  const auto length = std::uint32_t(text.size());
  return "\x93NUMPY" + std::string{char(version), '\0'} +
         (version == 1 ? bytes_of<std::uint16_t>({std::uint16_t(length)}) : bytes_of<std::uint32_t>({length})) + text;
}
inline std::string npy_sample(const std::string& descr, const std::string& shape, bool fortran_order = false) {
  return npy_header(descr, shape, fortran_order) + bytes_of(ramp());
}

inline std::string vtk_header(const std::string& encoding) {
  return "# vtk DataFile Version 3.0\ntitle\n" + encoding +
         "\nDATASET STRUCTURED_POINTS\nDIMENSIONS 3 2 2\nSPACING 0.5 2 4\nORIGIN 10 20 30\nPOINT_DATA 12\n"
         "SCALARS s short 1\nLOOKUP_TABLE default\n";
}

/// A file of several arrays, strings among them; the ramp is the scalars of points behind the others.
std::string vtk_arrays_sample(bool text);

/// What a test changes of a VTK XML file. Its array is `ramp` as text.
struct VtiParts {
  std::string file = R"(type="ImageData" version="1.0" byte_order="LittleEndian")";
  std::string image = R"(WholeExtent="0 2 0 1 0 1" Origin="10 20 30" Spacing="0.5 2 4")";
  std::string extent = "0 2 0 1 0 1";
  std::string section = R"(PointData Scalars="ramp")";
  std::string array = R"(type="Int16" Name="ramp" format="ascii")";
  std::string data = "0 1 2 3 4 5 6 7 8 9 10 11";
  std::string more{};      ///< arrays behind it
  std::string appended{};  ///< attribute of AppendedData, and what is in them
};
inline std::string vti_sample(const VtiParts& parts = {}) {
  const std::string section = parts.section.substr(0, parts.section.find(' '));
  return fmt::format(
      "<VTKFile {}>\n<ImageData {}>\n<Piece Extent=\"{}\">\n<{}>\n<DataArray {}>{}</DataArray>\n{}</{}>\n</Piece>\n"
      "</ImageData>\n{}</VTKFile>",
      parts.file, parts.image, parts.extent, parts.section, parts.array, parts.data, parts.more, section,
      parts.appended.empty() ? "" : fmt::format("<AppendedData encoding={}\n</AppendedData>\n", parts.appended));
}
/// Bytes in front of values as VTK XML has them: their size or, in blocks of zlib, the sizes of these.
struct VtiCode {
  bool big_endian = false;
  bool wide = false;
  std::size_t block = 0;  ///< bytes of a block; 0 without zlib
  bool base64 = false;
};
/// An array's bytes by the definition of VTK XML ("VTK File Formats"), `data` being those of its values.
std::string vti_coded(const std::string& data, const VtiCode& code);
/// The sample's ramp in base64, in blocks of 10 bytes.
inline std::string vti_zlib_sample() {
  return vti_sample(
      {.file = R"(type="ImageData" version="0.1" byte_order="LittleEndian" compressor="vtkZLibDataCompressor")",
       .array = R"(type="Int16" Name="ramp" format="binary")",
       .data = vti_coded(bytes_of(ramp()), {.block = 10, .base64 = true})});
}
inline std::string vti_raw_sample() {
  return vti_sample({.array = R"(type="Int16" Name="ramp" format="appended" offset="0")",
                     .data = {},
                     .appended = "\"raw\">_" + vti_coded(bytes_of(ramp()), {})});
}

/// One page of 3x2 pixels, little endian, uncompressed, its values from `first` on.
inline std::string tiff_sample(int first) {
  std::string bytes("II*\0\x08\0\0\0", 8);
  const std::vector<std::array<std::uint32_t, 3>> tags = {// tag, type, value
                                                          {256, 3, 3}, {257, 3, 2}, {258, 3, 16},
                                                          {259, 3, 1}, {262, 3, 1}, {273, 4, 8 + 2 + 9 * 12 + 4},
                                                          {277, 3, 1}, {278, 3, 2}, {279, 4, 12}};
  bytes += bytes_of<std::uint16_t>({std::uint16_t(tags.size())});
  for (const auto& tag : tags)
    bytes +=
        bytes_of<std::uint16_t>({std::uint16_t(tag[0]), std::uint16_t(tag[1])}) + bytes_of<std::uint32_t>({1, tag[2]});
  return bytes + bytes_of<std::uint32_t>({0}) + bytes_of(ramp(6, first));
}

/// Two samples as the pages of one file: the second moved behind the first.
inline std::string two_pages(std::string first, std::string second) {
  const auto tags = [](const std::string& page) { return std::size_t(page[8]); };
  put<std::uint32_t>(second, 10 + 5 * 12 + 8, std::uint32_t(first.size() + second.size() - 8 - 12));
  put<std::uint32_t>(first, 10 + tags(first) * 12, std::uint32_t(first.size()));
  return first + second.substr(8);
}

/// One element of explicit value representation, its text padded to an even length.
inline std::string dicom_element(std::uint16_t group, std::uint16_t element, const std::string& kind,
                                 std::string value) {
  if (value.size() % 2 != 0) value += kind == "UI" ? '\0' : ' ';
  std::string bytes = bytes_of<std::uint16_t>({group, element}) + kind;
  if (kind == "OW" || kind == "OB")
    bytes += std::string(2, '\0') + bytes_of<std::uint32_t>({std::uint32_t(value.size())});
  else
    bytes += bytes_of<std::uint16_t>({std::uint16_t(value.size())});
  return bytes + value;
}

struct DicomSlice {
  std::string position = "10\\20\\30";
  std::string series = "1.2.3";
  std::string instance = "1";
  int first = 0;  ///< first stored value; the file's intercept is -1000
};

/// CT, 3x2 pixels, rows along x, spacing 0.5 along x and 2 along y.
inline std::string dicom_sample(const DicomSlice& slice) {
  const auto number = [](std::uint16_t v) { return bytes_of<std::uint16_t>({v}); };
  const std::string ct = "1.2.840.10008.5.1.4.1.1.2";
  const std::string meta = dicom_element(2, 1, "OB", std::string("\0\1", 2)) + dicom_element(2, 2, "UI", ct) +
                           dicom_element(2, 3, "UI", "1.2.3.4." + slice.instance) +
                           dicom_element(2, 16, "UI", "1.2.840.10008.1.2.1") + dicom_element(2, 18, "UI", "1.2.3.9");
  return std::string(128, '\0') + "DICM" +
         dicom_element(2, 0, "UL", bytes_of<std::uint32_t>({std::uint32_t(meta.size())})) + meta +
         dicom_element(8, 0x16, "UI", ct) + dicom_element(8, 0x18, "UI", "1.2.3.4." + slice.instance) +
         dicom_element(8, 0x60, "CS", "CT") + dicom_element(0x20, 0xD, "UI", "1.2") +
         dicom_element(0x20, 0xE, "UI", slice.series) + dicom_element(0x20, 0x13, "IS", slice.instance) +
         dicom_element(0x20, 0x32, "DS", slice.position) + dicom_element(0x20, 0x37, "DS", "1\\0\\0\\0\\1\\0") +
         dicom_element(0x28, 2, "US", number(1)) + dicom_element(0x28, 4, "CS", "MONOCHROME2") +
         dicom_element(0x28, 0x10, "US", number(2)) + dicom_element(0x28, 0x11, "US", number(3)) +
         dicom_element(0x28, 0x30, "DS", "2\\0.5") + dicom_element(0x28, 0x100, "US", number(16)) +
         dicom_element(0x28, 0x101, "US", number(16)) + dicom_element(0x28, 0x102, "US", number(15)) +
         dicom_element(0x28, 0x103, "US", number(1)) + dicom_element(0x28, 0x1052, "DS", "-1000") +
         dicom_element(0x28, 0x1053, "DS", "1") + dicom_element(0x7FE0, 0x10, "OW", bytes_of(ramp(6, slice.first)));
}

/// MRC, int16, columns along y, rows along z, sections along x; 3, 2 and 2 of them.
inline std::string mrc_sample(bool big = false) {
  std::string bytes(1024, '\0');
  const std::array<std::int32_t, 10> start = {3, 2, 2, 1, 1, 5, 0, 2, 3, 2};
  for (std::size_t i = 0; i < start.size(); ++i) put<std::int32_t>(bytes, 4 * i, start.at(i), big);
  const std::array<float, 6> cell = {2.0f, 6.0f, 8.0f, 90.0f, 90.0f, 90.0f};
  for (std::size_t i = 0; i < cell.size(); ++i) put<float>(bytes, 40 + 4 * i, cell.at(i), big);
  const std::array<std::int32_t, 3> order = {2, 3, 1};
  for (std::size_t i = 0; i < 3; ++i) put<std::int32_t>(bytes, 64 + 4 * i, order.at(i), big);
  bytes.replace(208, 4, "MAP ");
  bytes.replace(212, 2, big ? "\x11\x11" : "\x44\x44");
  return bytes + bytes_of(ramp(), big);
}

/// gzip of bytes.
std::string gzipped(const std::string& bytes);

}  // namespace isolux::test
