#include "texel_row.h"

namespace isolux {

TexelRow::TexelRow(const NearField& near_field, const Lattice& texels)
    : near_field_(near_field), to_volume_(index_to_index(texels, near_field.field().lattice())) {}

void TexelRow::look(int j, int k, std::span<const int> columns) {
  points_.clear();
  for (const int i : columns) points_.push_back(to_volume_.world(Vec3(i, j, k)));
  sample_field(near_field_.field(), points_, samples_);
  texels_.resize(columns.size());
  for (std::size_t n = 0; n < columns.size(); ++n) {
    texels_[n] = {
        .index = points_.at(n), .isovalue = samples_.values[n], .ahead = near_field_.ahead_of(samples_.gradient(n))};
  }
}

void TexelRow::keep_lit(std::vector<int>& columns) {
  std::size_t kept = 0;
  for (std::size_t n = 0; n < texels_.size(); ++n) {
    const bool may_be_flat = samples_.least[n] == samples_.largest[n];
    if (may_be_flat && near_field_.field().is_flat_around(texels_[n].index)) continue;
    texels_[kept] = texels_[n];
    columns[kept++] = columns[n];
  }
  texels_.resize(kept);
  columns.resize(kept);
}

void TexelRow::find_openness(double step) {
  points_.clear();
  for (const Texel& texel : texels_) points_.push_back(texel.index + step * texel.ahead.step);
  sample_values(near_field_.field(), points_, values_);
  openness_.resize(texels_.size());
  for (std::size_t n = 0; n < texels_.size(); ++n) {
    const Texel& texel = texels_[n];
    const bool has_gradient = texel.ahead.fall > 0.0;
    openness_[n] = has_gradient ? NearField::openness_of(values_[n], texel.ahead, texel.isovalue, step) : 0.0f;
  }
}

}  // namespace isolux
