#include "model/viewed_volume.h"

#include <utility>
#include <variant>

namespace isolux::viewer {

ViewedVolume::ViewedVolume(StoredVolume volume) {
  if (std::holds_alternative<Grid<float>>(volume.values))
    floats_ = to_floats(std::move(volume));
  else
    narrow_ = std::move(volume);
}

const Volume& ViewedVolume::floats() const {
  std::call_once(once_, [this] {
    if (narrow_) floats_ = to_floats(*narrow_);
  });
  return floats_;
}

}  // namespace isolux::viewer
