#pragma once

#include <isolux/core/run.h>
#include <isolux/mc_extract/iso_mesh.h>
#include <isolux/raytrace_flat/gather.h>

#include <memory>
#include <utility>

#include "peer_embree.h"
#include "stats.h"
#include "suite.h"

namespace isolux::bench {

/// Embree on the mesh of one isosurface, which is what somebody would use who lights surfaces one by one.
class EmbreeSpeed {
 public:
  EmbreeSpeed(const Volume& volume, float isovalue, const SuiteContext& context);
  [[nodiscard]] bool exists() const { return embree_ != nullptr; }
  [[nodiscard]] double build_seconds() const { return embree_->build_seconds(); }

  /// Million rays a second of the fastest call, and which that is. Takes about `seconds`. \pre exists()
  [[nodiscard]] std::pair<Estimate, EmbreeCall> measured(RayQuestion question, const Run& run, double seconds) const;

 private:
  [[nodiscard]] Estimate of_call(EmbreeCall call, RayQuestion question, const Run& run, double seconds) const;

  IsoMesh mesh_;
  std::unique_ptr<const EmbreeMesh> embree_;
};

}  // namespace isolux::bench
