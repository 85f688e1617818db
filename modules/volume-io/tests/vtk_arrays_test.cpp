#include "itk_fixture.h"

#include <gmock/gmock.h>

namespace isolux {
namespace {
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Files as VTK 9.1 writes them of several arrays.
class VtkArrays : public test::RampFile {
 protected:
  static std::string start(bool text) {
    return std::string("# vtk DataFile Version 5.1\nvtk output\n") + (text ? "ASCII" : "BINARY") +
           "\nDATASET STRUCTURED_POINTS\n";
  }
  static std::string geometry() { return "DIMENSIONS 3 2 2\nSPACING 0.5 2 4\nORIGIN 10 20 30\n"; }
  /// Whole numbers from `first` on, the file's way.
  template <class T>
  static std::string numbers(bool text, int count, int first = 0) {
    std::vector<T> values;
    std::string words;
    for (int i = 0; i < count; ++i) {
      values.push_back(T(first + i));
      words += fmt::format("{}{}", first + i, i % 9 == 8 ? " \n" : " ");
    }
    return (text ? words : test::bytes_of(values, true)) + "\n";
  }
  static std::string scalars(bool text, const std::string& name = "s", int first = 0) {
    return "SCALARS " + name + " short\nLOOKUP_TABLE default\n" + numbers<std::int16_t>(text, 12, first);
  }
  [[nodiscard]] Volume read(const std::string& bytes, const std::string& array = {}) const {
    ReadOptions options;
    if (!array.empty()) options.settings["vtk"]["array"] = array;
    return read_volume(folder_.write("a.vtk", bytes), options);
  }
  /// What VTK notes of an array, here without a name for its second component.
  static std::string metadata(int components) {
    return std::string("METADATA\nCOMPONENT_NAMES\nx%20comp\n") + (components == 3 ? "\nz\n" : "") +
           "INFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 11\n\n";
  }
};

TEST_F(VtkArrays, BeforeTheScalarsArePassedOver) {
  for (const bool text : {false, true}) {
    const std::string before[] = {"VECTORS v float\n" + numbers<float>(text, 36) + metadata(3),
                                  "NORMALS n double\n" + numbers<double>(text, 36),
                                  "TENSORS t float\n" + numbers<float>(text, 108),
                                  "TENSORS6 t float\n" + numbers<float>(text, 72),
                                  "TEXTURE_COORDINATES c 2 float\n" + numbers<float>(text, 24),
                                  "GLOBAL_IDS g vtkIdType\n" + numbers<std::int32_t>(text, 12),
                                  "COLOR_SCALARS rgb 3\n" + (text ? numbers<float>(true, 36) : std::string(36, '\n')),
                                  "LOOKUP_TABLE l 2\n" + (text ? numbers<float>(true, 8) : std::string(8, '\n')),
                                  "FIELD FieldData 2\nf%20f 3 12 float\n" + numbers<float>(text, 36) + metadata(3) +
                                      "b 1 12 bit\n" + (text ? numbers<int>(true, 12) : "\n \n")};
    for (const std::string& array : before) {
      const Volume volume = read(start(text) + geometry() + "POINT_DATA 12\n" + array + scalars(text));
      expect_ramp(volume);
      EXPECT_EQ(volume.stored_type, ScalarType::kInt16) << array;
      EXPECT_EQ(volume.remarks.empty(), array.starts_with("LOOKUP_TABLE")) << array;
    }
  }
}

TEST_F(VtkArrays, OfTheWholeDataSetAreNoVolumes) {
  for (const bool text : {false, true}) {
    const std::string lengthy(20000, 'y');
    const std::string strings =
        text ? "a%20b\n\nSCALARS x\n" + lengthy + "\n"
             : "\xC3" + std::string("a b\xC0\x80\x09SCALARS x\x40\x00\x4E\x20", 19) + lengthy + "\n";
    const std::string fields = "FIELD FieldData 3\nTimeValue 1 1 double\n" + numbers<double>(text, 1) + metadata(1) +
                               "NULL_ARRAY\nnotes 1 4 string\n" + strings;
    const Volume volume = read(start(text) + fields + geometry() + "POINT_DATA 12\n" + scalars(text));
    expect_ramp(volume);
    EXPECT_THAT(volume.remarks, IsEmpty());
  }
}

TEST_F(VtkArrays, MayBeCalledWhatStandsBetweenThem) {
  for (const bool text : {false, true}) {
    for (const std::string name : {"METADATA", "NULL_ARRAY", "SCALARS"}) {
      const std::string file = start(text) + geometry() + "POINT_DATA 12\nFIELD FieldData 2\n" + name +
                               " 1 12 float\n" + numbers<float>(text, 12, 7) + "f 1 12 float\n" +
                               numbers<float>(text, 12);
      EXPECT_EQ(read(file, name).values.values()[0], 7.0f) << name;
      EXPECT_EQ(read(file, "f").values.values()[11], 11.0f) << name;
    }
  }
}

TEST_F(VtkArrays, OfPointsComeBeforeThoseOfCells) {
  for (const bool text : {false, true}) {
    const std::string cells = "CELL_DATA 2\nSCALARS c float\nLOOKUP_TABLE default\n" + numbers<float>(text, 2, 7);
    const std::string points = "POINT_DATA 12\n" + scalars(text);
    for (const std::string& both : {cells + points, points + cells}) {
      const Volume volume = read(start(text) + geometry() + both);
      expect_ramp(volume);
      EXPECT_THAT(volume.remarks, ElementsAre(HasSubstr("a.vtk: the array 's' is read, not 'c' of cells")));
    }
    const Volume of_cells = read(start(text) + geometry() + cells);
    EXPECT_EQ(of_cells.lattice().size, Index3(2, 1, 1));
    EXPECT_EQ(of_cells.lattice().frame.origin, Vec3(10.25, 21, 32)) << "voxels are the cells' centres";
    EXPECT_THAT(test::values_of(of_cells), ElementsAre(7.0f, 8.0f));
    EXPECT_THAT(of_cells.remarks, IsEmpty());
  }
}

TEST_F(VtkArrays, AreChosenByNameElseTheScalarsBeforeOthersAndIdsLast) {
  for (const bool text : {false, true}) {
    const std::string file = start(text) + geometry() + "POINT_DATA 12\nGLOBAL_IDS g vtkIdType\n" +
                             numbers<std::int32_t>(text, 12, 50) + "FIELD FieldData 2\nmy%20f 1 12 float\n" +
                             numbers<float>(text, 12, 100) + "of_9 1 9 float\n" + numbers<float>(text, 9);
    EXPECT_EQ(read(file).values.values()[0], 100.0f) << "any before ids";
    const Volume volume = read(file + scalars(text) + scalars(text, "s2", 200));
    expect_ramp(volume);
    EXPECT_THAT(volume.remarks,
                ElementsAre(HasSubstr("'s' is read, not 'g', 'my f', 'of_9' (9 of them, DIMENSIONS make "
                                      "12), 's2'; --set-reader vtk.array=NAME")));
    const Volume named = read(file + scalars(text) + scalars(text, "s2", 200), "my f");
    EXPECT_EQ(named.values.values()[11], 111.0f);
    EXPECT_EQ(named.stored_type, ScalarType::kFloat32);
    EXPECT_THAT(named.remarks, IsEmpty()) << "who names one knows of others";
    EXPECT_EQ(read(file, "g").values.values()[0], 50.0f);
    for (const std::string none : {"my%20f", "of_9", "x"})
      EXPECT_THAT(
          test::error_of([&] { (void)read(file, none); }),
          HasSubstr("a.vtk: VTK: an array '" + none + "' of one number a point or cell is needed; there is 'g'"));
  }
  const std::string ghosts = "FIELD FieldData 1\nvtkGhostType 1 12 unsigned_char\n" + std::string(12, '\0') + "\n";
  EXPECT_THAT(refused("a.vtk", start(false) + geometry() + "POINT_DATA 12\n" + ghosts), HasSubstr("'vtkGhostType'"));
  expect_ramp(read(start(false) + geometry() + "POINT_DATA 12\n" + ghosts + scalars(false)));
}

TEST_F(VtkArrays, BehindWhatCannotBeFollowedAreLeftOutWithARemark) {
  for (const bool text : {false, true}) {
    const std::string file = start(text) + geometry() + "POINT_DATA 12\n" + scalars(text);
    const auto remark_of = [&](const std::string& more) {
      const Volume volume = read(file + more);
      expect_ramp(volume);
      return volume.remarks;
    };
    EXPECT_THAT(remark_of("\n"), IsEmpty());
    EXPECT_THAT(remark_of(metadata(1)), IsEmpty());
    EXPECT_THAT(remark_of("BOGUS x\n"),
                ElementsAre(HasSubstr("'BOGUS x': this is no part of DATASET STRUCTURED_POINTS; "
                                      "it is read no further")));
    EXPECT_THAT(remark_of("VECTORS v float\n0 0"),
                ElementsAre(HasSubstr("not 'v' (3 components)"), HasSubstr("the file ends within the VTK array 'v'")));
    EXPECT_THAT(remark_of("FIELD FieldData 2\nf 1 0 float\n"), ::testing::Contains(HasSubstr("2 arrays")));
    EXPECT_THAT(remark_of("FIELD FieldData 1\nf 4294967296 4294967296 float\n"),
                ::testing::Contains(HasSubstr("more values than a file holds")));
    EXPECT_THAT(remark_of("SPACING 0 0 0\n"), ElementsAre(HasSubstr("other than 0")));
  }
  const std::string first = start(false) + geometry() + "POINT_DATA 12\n";
  EXPECT_THAT(refused("a.vtk", first + "FIELD FieldData 1\nf 1 12 variant\n" + scalars(false)),
              HasSubstr("'f': of type 'variant', whose size is unknown"));
  EXPECT_THAT(refused("a.vtk", first + "VECTORS v float\n"), HasSubstr("ends within the VTK array 'v'"));
}

}  // namespace
}  // namespace isolux
