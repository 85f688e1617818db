#include "vtk_xml_text.h"

#include "byte_source.h"
#include "files.h"
#include "text_values.h"

#include <fmt/format.h>
#include <isolux/core/error.h>

#include <algorithm>

namespace isolux::detail {
namespace {

constexpr std::string_view kRoot = "<VTKFile";
constexpr std::string_view kRootEnd = "</VTKFile>";
constexpr std::string_view kAppended = "<AppendedData";
// A file has a line or two before its root, blanks and comments behind it, and before the underscore of its data.
constexpr std::size_t kAroundRoot = 4096;
constexpr std::size_t kTextPiece = 1 << 16;

/// Reads on until there are `size` bytes, or no more; whether there were any.
bool read_to(ByteSource& source, std::string& bytes, std::size_t size) {
  const std::size_t before = bytes.size();
  if (before >= size) return true;
  bytes.resize(size);
  bytes.resize(before + source.read(std::as_writable_bytes(std::span(bytes).subspan(before))));
  return bytes.size() > before;
}

void require_root_end(const std::string& path, std::uint64_t size) {
  std::string end;
  read_to(*file_source(path, size - std::min<std::uint64_t>(size, kAroundRoot)), end, kAroundRoot);
  if (end.find(kRootEnd) == std::string::npos)
    throw IoError(fmt::format("{}: '{}' is missing at its end: the file is cut off", path, kRootEnd));
}

}  // namespace

bool is_vtk_xml(const std::string& path) {
  const std::string bytes = first_bytes(path, kAroundRoot);
  std::string_view rest = bytes;
  if (rest.starts_with("\xEF\xBB\xBF")) rest.remove_prefix(3);
  rest.remove_prefix(std::min(rest.find_first_not_of(kTextBlanks), rest.size()));
  return rest.starts_with('<') && rest.find(kRoot) != std::string_view::npos;
}

VtkXmlText read_vtk_xml_text(const std::string& path) {
  const std::uint64_t size = require_file(path);
  if (!is_vtk_xml(path)) throw InvalidInput(fmt::format("{}: no VTK XML file: '{}' is missing", path, kRoot));
  require_root_end(path, size);
  const auto source = file_source(path, 0);
  VtkXmlText xml;
  std::size_t tag = std::string::npos;
  for (std::size_t seen = 0; read_to(*source, xml.text, xml.text.size() + kTextPiece);) {
    tag = xml.text.find(kAppended, seen);
    if (tag != std::string::npos) break;
    seen = xml.text.size() - std::min(xml.text.size(), kAppended.size());
  }
  if (tag == std::string::npos) return xml;
  (void)read_to(*source, xml.text, tag + kAroundRoot);
  const std::size_t begin =
      xml.text.find_first_not_of(kTextBlanks, std::min(xml.text.find('>', tag), xml.text.size() - 1) + 1);
  if (begin == std::string::npos || xml.text[begin] != '_')
    throw InvalidInput(fmt::format("{}: VTK XML: AppendedData do not begin with '_'", path));
  xml.appended = begin + 1;
  xml.text.resize(begin);
  xml.text += fmt::format("</AppendedData>{}", kRootEnd);
  return xml;
}

}  // namespace isolux::detail
