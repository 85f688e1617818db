// Writes what each fuzz target begins with: isolux_fuzz_seeds FOLDER makes FOLDER/TARGET/NAME.
#include <isolux/bake/bake.h>
#include <isolux/bake/light_metadata.h>
#include <isolux/bake/scene_file.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include <ImfRgbaFile.h>

#include "samples.h"
#include "vti_of_vtk.h"

namespace {

using namespace isolux;
using Seeds = std::map<std::string, std::string>;

Seeds volumes() {
  const std::string head = "NRRD0005\ntype: short\ndimension: 3\nsizes: 3 2 2\nendian: little\n";
  const std::string frame =
      "space: LPS\nspace directions: (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\nkey:=value\n";
  const std::string ramp = test::bytes_of(test::ramp());
  const std::string numbers = "0 1 2 3 4 5 6 7 8 9 10 11";
  return {
      {"raw.nrrd", head + "encoding: raw\n" + frame + "\n" + ramp},
      {"gzip.nrrd", head + "encoding: gzip\n" + frame + "\n" + test::gzipped(ramp)},
      {"text.nrrd", head + "encoding: ascii\n" + frame + "\n" + numbers},
      {"detached.nhdr", head + "encoding: raw\n" + frame + "data file: data.raw\n"},
      {"spacings.nrrd",
       "NRRD0001\ntype: float\ndimension: 4\nsizes: 1 2 2 2\nkinds: scalar domain domain domain\n"
       "spacings: nan 1 2 .5\nbyte skip: -1\nendian: big\nencoding: raw\n\n" +
           test::bytes_of(std::vector<float>{0, 1, 2, 3, 4, 5, 6, 7}, true)},
      {"vectors.nrrd",
       "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 3 2 2 2\nkinds: list domain domain domain\nencoding: raw\n\n" +
           ramp},
      {"text_times.nrrd",
       "NRRD0004\ntype: uchar\ndimension: 4\nsizes: 1 2 2 3\nkinds: domain domain domain time\nencoding: ascii\n\n" +
           numbers},
      {"a.nii", test::nifti_sample()},
      {"big.nii", test::nifti_sample(true)},
      {"a.nii.gz", test::gzipped(test::nifti_sample())},
      {"a.mrc", test::mrc_sample()},
      {"big.mrc", test::mrc_sample(true)},
      {"a.mrc.gz", test::gzipped(test::mrc_sample())},
      {"a.npy", test::npy_sample("<i2", "(2, 2, 3)")},
      {"fortran.npy", test::npy_sample(">i2", "(3, 2, 2)", true)},
      {"times.npy", test::npy_sample("<i1", "(2, 3, 2, 2)")},
      {"half.npy", test::npy_sample("<f2", "(1, 2, 2, 3)")},
      {"a.vtk", test::vtk_header("BINARY") + ramp},
      {"text.vtk", test::vtk_header("ASCII") + numbers},
      {"arrays.vtk", test::vtk_arrays_sample(false)},
      {"text_arrays.vtk", test::vtk_arrays_sample(true)},
      {"a.vti", test::vti_sample()},
      {"zlib.vti", test::vti_zlib_sample()},
      {"raw.vti", test::vti_raw_sample()},
      {"vtk.vti", test::kVtkAppendedBase64ZlibWideBigEndian}};
}

/// Behind a byte of options and their name.
Seeds named() {
  Seeds seeds;
  for (const auto& [name, bytes] : volumes()) seeds[name] = std::string(1, '\0') + name + "\n" + bytes;
  const std::string ramp = test::bytes_of(test::ramp());
  seeds["name.raw"] = std::string(1, '\1') + "a_3x2x2_int16.raw\n" + ramp;
  seeds["told.raw"] = std::string(1, char(16 + 32 * int(ScalarType::kInt16))) + "a.dat\n" + ramp;
  return seeds;
}

Seeds foreign() {
  const std::string local = test::meta_header("LOCAL", "CompressedData = False\n");
  return {{"a.tif", test::tiff_sample(0)},
          {"two.tif", test::two_pages(test::tiff_sample(0), test::tiff_sample(6))},
          {"a.dcm", test::dicom_sample({})},
          {"a.mha", local + test::bytes_of(test::ramp())},
          {"a.mhd", test::meta_header("data.raw")}};
}

Seeds scenes() {
  const Seeds seeds = {
      {"empty", "{}"},
      {"uniform", R"({"environment":{"type":"uniform","radiance":[1,0.5,0.25]},"sides":"both",)"
                  R"("albedo":[0.8,0.7,0.6]})"},
      {"sky", R"({"environment":{"type":"sky","up":[0,1,0],"zenith":[1,1,1],"horizon":[0.5,0.5,0.5],)"
              R"("ground":[0,0,0]},"outer":"higher","emission":[0,0,1],)"
              R"("albedo":{"by_isovalue":[[0,0.1,0.2,0.3],[1,0.4,0.5,0.6]]}})"},
      {"lights", R"({"lights":[{"type":"sun","direction":[0,0,1],"irradiance":[3,3,3],"angular_diameter_deg":1},)"
                 R"({"type":"sphere","center":[0,0,2],"radius":0.5,"radiance":[1,1,1]},)"
                 R"({"type":"rectangle","center":[0,0,2],"u":[1,0,0],"v":[0,1,0],"radiance":[1,1,1]}]})"},
      {"image", R"({"environment":{"type":"image","file":"sky.hdr","up":[0,0,1]}})"}};
  for (const auto& [name, text] : seeds)
    if (name != "image") (void)parse_scene(text, "", name);  // a seed that is refused leads nowhere
  return seeds;
}

std::string exr_picture() {
  const test::TemporaryFolder folder;
  const std::array<Imf::Rgba, 4> pixels = {Imf::Rgba(1, 2, 4), Imf::Rgba(0, 0, 0), Imf::Rgba(.5, .5, .5), Imf::Rgba()};
  const std::string path = folder.file("a.exr");
  {
    Imf::RgbaOutputFile file(path.c_str(), 2, 2, Imf::WRITE_RGB);
    file.setFrameBuffer(pixels.data(), 1, 2);
    file.writePixels(2);
  }
  return test::read_file(path);
}

Seeds pictures() {
  const std::string head = "#?RADIANCE\nEXPOSURE=2\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 8\n";
  std::string runs("\2\2\0\x8", 4);
  for (int c = 0; c < 4; ++c) runs += "\x88\x80";
  return {{"flat.hdr", head + std::string(32, '\x80')},
          {"runs.hdr", head + runs},
          {"a.exr", exr_picture()},
          {"a.pgm", "P5 2 1 255\nab"},
          {"a.bmp", "BM"}};
}

/// One light of each kind of detail, over gen:gyroid:4.
Seeds lights() {
  Seeds seeds;
  const test::TemporaryFolder folder;
  const Volume volume = sample_analytic_field("gyroid", 4);
  const Stages stages = builtin_stages();
  Scene both;
  both.sides = LitSides::kBoth;
  both.environment = SkyEnvironment{.zenith = Vec3f(0.2f, 0.4f, 0.9f)};
  for (const auto& [name, scene] : std::map<std::string, Scene>{{"grey", {}}, {"both", both}}) {
    for (const std::string resampler : {"direct", "fit", "cell_grid"}) {
      BakeSettings settings;
      settings.resampler.name = resampler;
      settings.trace.rays = 16;
      settings.texels = Index3(2);
      Run run;
      LightFile light = make_light_file(bake(volume, scene, settings, stages, run), volume, scene, run);
      const std::string path = folder.file("a.nrrd");
      write_light(light, path, volume.space);
      seeds[name + "-" + resampler] = test::read_file(path);
    }
  }
  return seeds;
}

Seeds tables() {
  return {{"bare", "1 2 3\n4 5 6\n"},
          {"named", "name,x,y,z\n\"a \"\"b\"\"\",1,2,3\n# no\n\nc,4,5,6\n"},
          {"tabs", "x\ty\tz\tw\n1\t2\t3\t\n"},
          {"semicolons", "\xEF\xBB\xBFx;y;z\r\n1;2;3\r\n"}};
}

Seeds options() {
  return {{"size", "n3x2x2"},
          {"numbers", "n1,-2e3,.5"},
          {"bounces", "nall"},
          {"type", "nuint16"},
          {"isovalue", "i2.5sigma"},
          {"isovalues", "i0,1:2:3,-1sigma"},
          {"range", "i2sigma:3sigma"},
          {"picture", "p30,20\n0,0,1\n255,0,0\n800x600\n1,2,3"},
          {"light", "l0:1\n4x4x4\nfit\nstratified\nneed\nresampler.iterations=3\nsampler.x=1"},
          {"time_limit", "stime_limit=3600"},
          {"array", "sarray=name\nreader.array=x"},
          {"k", "sk=11\nexponent=2.5\nresampler.denoise=true"}};
}

/// Bytes of volumes behind those of settings: a ball, ties, noise of all bits.
Seeds fields(std::size_t settings) {
  Seeds seeds;
  for (int kind = 0; kind < 4; ++kind) {
    std::string bytes(settings, '\0');
    bytes += {char(kind), 2, 2, 2};
    const Volume volume = sample_analytic_field("gyroid", 4);
    for (const float value : volume.values.values()) {
      if (kind < 2) bytes += test::bytes_of<float>({value});
      if (kind == 2) bytes += char(value * 2.0f);
      if (kind == 3) bytes += test::bytes_of<std::int16_t>({std::int16_t(value * 1000.0f)});
    }
    seeds["gyroid-" + std::to_string(kind)] = bytes + std::string("\2\3\0\6\0", 5);
  }
  return seeds;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("isolux_fuzz_seeds FOLDER\n", stderr);
    return 2;
  }
  const std::map<std::string, Seeds> targets = {
      {"volume_file", volumes()}, {"volume_name", named()},          {"foreign_header", foreign()},
      {"scene", scenes()},        {"environment_image", pictures()}, {"light_file", lights()},
      {"point_table", tables()},  {"option_text", options()},        {"surface", fields(3)},
      {"ray", fields(4)}};
  for (const auto& [target, seeds] : targets) {
    const auto folder = std::filesystem::path(argv[1]) / target;
    std::filesystem::create_directories(folder);
    for (const auto& [name, bytes] : seeds) std::ofstream(folder / name, std::ios::binary) << bytes;
  }
  return 0;
}
