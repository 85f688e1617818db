// The light file as ITK, and so 3D Slicer, reads it.
#include <gtest/gtest.h>
#include <isolux/core/lattice.h>
#include <isolux/volume_io/light_file.h>
#include <itkImageFileReader.h>
#include <itkNrrdImageIO.h>
#include <itkVectorImage.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace isolux {
namespace {

/// Stretched, turned and away from the origin; texel (i, j, k), channel c: 100 i + 10 j + k + c / 4.
IlluminationGrid turned_grid(int channels) {
  Lattice lattice{
      .size = {4, 3, 2},
      .frame = {.origin = {10.0, -20.0, 30.0}, .axes = Mat3({0.6, 0.8, 0.0}, {-1.6, 1.2, 0.0}, {0.0, 0.0, 3.0})}};
  IlluminationGrid grid(lattice, channels);
  std::size_t at = 0;
  for (int k = 0; k < 2; ++k)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 4; ++i)
        for (int c = 0; c < channels; ++c) grid.values[at++] = float(100 * i + 10 * j + k) + 0.25f * float(c);
  return grid;
}

class LightInItk : public testing::TestWithParam<int> {};

TEST_P(LightInItk, HasTheSameValuesAtTheSamePlaces) {
  const int channels = GetParam();
  const IlluminationGrid grid = turned_grid(channels);
  for (const bool compress : {false, true}) {
    const std::string path = testing::TempDir() + "isolux_itk_light_" + std::to_string(channels) + ".nrrd";
    write_light({.grid = grid, .metadata = {{"isolux.quantity", "irradiance/pi"}}}, path, "left-posterior-superior",
                {.compress = compress});
    using Image = itk::VectorImage<float, 3>;
    const auto reader = itk::ImageFileReader<Image>::New();
    reader->SetImageIO(itk::NrrdImageIO::New());
    reader->SetFileName(path);
    reader->Update();
    const Image& image = *reader->GetOutput();
    ASSERT_EQ(image.GetNumberOfComponentsPerPixel(), unsigned(channels));
    ASSERT_EQ(image.GetLargestPossibleRegion().GetSize(), (Image::SizeType{{4, 3, 2}}));
    std::size_t at = 0;
    for (int k = 0; k < 2; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 4; ++i) {
          const Image::IndexType index{{i, j, k}};
          for (int c = 0; c < channels; ++c) EXPECT_EQ(image.GetPixel(index)[unsigned(c)], grid.values[at++]);
          Image::PointType place;
          image.TransformIndexToPhysicalPoint(index, place);
          const Vec3 world = grid.lattice.frame.world({i, j, k});
          for (int a = 0; a < 3; ++a) EXPECT_NEAR(place[unsigned(a)], world[a], 1e-12) << "ITK works in doubles";
        }
      }
    }
    std::filesystem::remove(path);
  }
}

INSTANTIATE_TEST_SUITE_P(Channels, LightInItk, testing::Values(1, 3));

/// The number of side s, kind k (value, slope) and channel c of a texel differ by a quarter each, in that order.
TEST(LightOfBothSidesInItk, HasTheInnerSidesNumbersBehindTheOuter) {
  for (const int channels : {1, 3}) {
    for (const bool sloped : {false, true}) {
      const int a_side = channels * (sloped ? 2 : 1);
      const IlluminationGrid all = turned_grid(2 * a_side);
      LightFile light{.grid = IlluminationGrid(all.lattice, channels), .metadata = {}};
      light.inner = light.grid;
      for (int s = 0; s < 2; ++s) {
        IlluminationGrid& side = s == 0 ? light.grid : *light.inner;
        side.detail.slopes.resize(sloped ? side.values.size() : 0);
        for (std::size_t at = 0; at < side.values.size(); ++at) {
          const auto c = std::size_t(channels);
          const std::size_t from = at / c * 2 * std::size_t(a_side) + std::size_t(s * a_side) + at % c;
          side.values[at] = all.values[from];
          if (sloped) side.detail.slopes[at] = all.values[from + c];
        }
      }
      const std::string path = testing::TempDir() + "isolux_itk_both_sides.nrrd";
      write_light(light, path, "left-posterior-superior");
      using Image = itk::VectorImage<float, 3>;
      const auto reader = itk::ImageFileReader<Image>::New();
      reader->SetImageIO(itk::NrrdImageIO::New());
      reader->SetFileName(path);
      reader->Update();
      ASSERT_EQ(reader->GetOutput()->GetNumberOfComponentsPerPixel(), unsigned(2 * a_side));
      const float* read = reader->GetOutput()->GetBufferPointer();
      EXPECT_EQ(std::vector<float>(read, read + all.values.size()), all.values);
      std::filesystem::remove(path);
    }
  }
}

}  // namespace
}  // namespace isolux
