#include "vtk_words.h"

#include "plain_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <map>

namespace isolux::detail {

std::optional<ScalarType> vtk_scalar_type(const std::string& word) {
  // A vtkIdType has eight bytes in memory, and four in what VTK writes and reads.
  static const std::map<std::string, ScalarType> types = {{"char", ScalarType::kInt8},
                                                          {"signed_char", ScalarType::kInt8},
                                                          {"unsigned_char", ScalarType::kUint8},
                                                          {"short", ScalarType::kInt16},
                                                          {"unsigned_short", ScalarType::kUint16},
                                                          {"int", ScalarType::kInt32},
                                                          {"vtkidtype", ScalarType::kInt32},
                                                          {"unsigned_int", ScalarType::kUint32},
                                                          {"long", ScalarType::kInt64},
                                                          {"unsigned_long", ScalarType::kUint64},
                                                          {"long_long", ScalarType::kInt64},
                                                          {"unsigned_long_long", ScalarType::kUint64},
                                                          {"vtktypeint64", ScalarType::kInt64},
                                                          {"vtktypeuint64", ScalarType::kUint64},
                                                          {"float", ScalarType::kFloat32},
                                                          {"double", ScalarType::kFloat64}};
  const auto it = types.find(lower_case(word));
  return it == types.end() ? std::nullopt : std::optional(it->second);
}

std::string vtk_decoded(const std::string& name) {
  std::string text;
  for (std::size_t i = 0; i < name.size(); ++i) {
    unsigned code = 0;
    if (name[i] == '%' && i + 2 < name.size() &&
        std::from_chars(&name[i] + 1, &name[i] + 3, code, 16).ptr == &name[i] + 3) {
      text += char(code);
      i += 2;
    } else {
      text += name[i];
    }
  }
  return text;
}

const VtkAttribute* find_vtk_attribute(std::string_view keyword) {
  static constexpr std::array<VtkAttribute, 10> kAttributes{{{"scalars", VtkRole::kScalars, 1, 3, 2},
                                                             {"color_scalars", VtkRole::kScalars, 0, 2, 0},
                                                             {"vectors", VtkRole::kOther, 3, 0, 2},
                                                             {"normals", VtkRole::kOther, 3, 0, 2},
                                                             {"tensors", VtkRole::kOther, 9, 0, 2},
                                                             {"tensors6", VtkRole::kOther, 6, 0, 2},
                                                             {"texture_coordinates", VtkRole::kOther, 0, 2, 3},
                                                             {"edge_flags", VtkRole::kOther, 1, 0, 2},
                                                             {"global_ids", VtkRole::kIds, 1, 0, 2},
                                                             {"pedigree_ids", VtkRole::kIds, 1, 0, 2}}};
  const auto* const found =
      std::find_if(kAttributes.begin(), kAttributes.end(), [&](const auto& known) { return keyword == known.keyword; });
  return found == kAttributes.end() ? nullptr : found;
}

}  // namespace isolux::detail
