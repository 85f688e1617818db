// What vtkXMLImageDataWriter of VTK 9.1 writes of one image: the ramp 0, 1, ... 11 of 3x2x2 points, by each way it has.
#pragma once

#include <string>

namespace isolux::test {

inline const std::string kVtkText(
    "<\?xml version=\"1.0\"\?>\n"
    "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
    "  <ImageData WholeExtent=\"1 3 -1 0 4 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 4\" Direction=\"0 -1 0 1 0 0 0 0 "
    "1\">\n"
    "  <Piece Extent=\"1 3 -1 0 4 5\">\n"
    "    <PointData Scalars=\"ramp\">\n"
    "      <DataArray type=\"Int16\" Name=\"ramp\" format=\"ascii\" RangeMin=\"0\" RangeMax=\"11\">\n"
    "        0 1 2 3 4 5\n"
    "        6 7 8 9 10 11\n"
    "      </DataArray>\n"
    "    </PointData>\n"
    "    <CellData>\n"
    "    </CellData>\n"
    "  </Piece>\n"
    "  </ImageData>\n"
    "</VTKFile>\n",
    512);

inline const std::string kVtkBase64(
    "<\?xml version=\"1.0\"\?>\n"
    "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
    "  <ImageData WholeExtent=\"1 3 -1 0 4 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 4\" Direction=\"0 -1 0 1 0 0 0 0 "
    "1\">\n"
    "  <Piece Extent=\"1 3 -1 0 4 5\">\n"
    "    <PointData Scalars=\"ramp\">\n"
    "      <DataArray type=\"Int16\" Name=\"ramp\" format=\"binary\" RangeMin=\"0\" RangeMax=\"11\">\n"
    "        GAAAAAAAAQACAAMABAAFAAYABwAIAAkACgALAA==\n"
    "      </DataArray>\n"
    "    </PointData>\n"
    "    <CellData>\n"
    "    </CellData>\n"
    "  </Piece>\n"
    "  </ImageData>\n"
    "</VTKFile>\n",
    520);

inline const std::string kVtkBase64Wide(
    "<\?xml version=\"1.0\"\?>\n"
    "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
    "  <ImageData WholeExtent=\"1 3 -1 0 4 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 4\" Direction=\"0 -1 0 1 0 0 0 0 "
    "1\">\n"
    "  <Piece Extent=\"1 3 -1 0 4 5\">\n"
    "    <PointData Scalars=\"ramp\">\n"
    "      <DataArray type=\"Int16\" Name=\"ramp\" format=\"binary\" RangeMin=\"0\" RangeMax=\"11\">\n"
    "        GAAAAAAAAAAAAAEAAgADAAQABQAGAAcACAAJAAoACwA=\n"
    "      </DataArray>\n"
    "    </PointData>\n"
    "    <CellData>\n"
    "    </CellData>\n"
    "  </Piece>\n"
    "  </ImageData>\n"
    "</VTKFile>\n",
    524);

inline const std::string kVtkBase64Zlib(
    "<\?xml version=\"1.0\"\?>\n"
    "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
    "compressor=\"vtkZLibDataCompressor\">\n"
    "  <ImageData WholeExtent=\"1 3 -1 0 4 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 4\" Direction=\"0 -1 0 1 0 0 0 0 "
    "1\">\n"
    "  <Piece Extent=\"1 3 -1 0 4 5\">\n"
    "    <PointData Scalars=\"ramp\">\n"
    "      <DataArray type=\"Int16\" Name=\"ramp\" format=\"binary\" RangeMin=\"0\" RangeMax=\"11\">\n"
    "        AwAAAAgAAAAAAAAAEAAAABAAAAAQAAAAeF5jYGBkYGJgZgAAABwAB3heY2FgZWBjYGcAAABsABd4XuNg4GTgYuBmAAAAvAAn\n"
    "      </DataArray>\n"
    "    </PointData>\n"
    "    <CellData>\n"
    "    </CellData>\n"
    "  </Piece>\n"
    "  </ImageData>\n"
    "</VTKFile>\n",
    611);

inline const std::string kVtkRaw(
    "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
    "  <ImageData WholeExtent=\"1 3 -1 0 4 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 4\" Direction=\"0 -1 0 1 0 0 0 0 "
    "1\">\n"
    "    <Piece Extent=\"1 3 -1 0 4 5\"                                                      >\n"
    "      <PointData Scalars=\"ramp\">\n"
    "        <DataArray type=\"Int16\" Name=\"ramp\" format=\"appended\" RangeMin=\"0\"                    "
    "RangeMax=\"11\"                   offset=\"0\"                   >\n"
    "        </DataArray>\n"
    "      </PointData>\n"
    "      <CellData>\n"
    "      </CellData>\n"
    "    </Piece>\n"
    "  </ImageData>\n"
    "  <AppendedData encoding=\"raw\">\n"
    "   _\030\000\000\000\000\000\001\000\002\000\003\000\004\000\005\000\006\000\007\000\010\000\011\000\n"
    "\000\013\000\n"
    "  </AppendedData>\n"
    "</VTKFile>\n",
    671);

inline const std::string kVtkRawZlib(
    "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\" "
    "compressor=\"vtkZLibDataCompressor\">\n"
    "  <ImageData WholeExtent=\"1 3 -1 0 4 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 4\" Direction=\"0 -1 0 1 0 0 0 0 "
    "1\">\n"
    "    <Piece Extent=\"1 3 -1 0 4 5\"                                                      >\n"
    "      <PointData Scalars=\"ramp\">\n"
    "        <DataArray type=\"Int16\" Name=\"ramp\" format=\"appended\" RangeMin=\"0\"                    "
    "RangeMax=\"11\"                   offset=\"0\"                   >\n"
    "        </DataArray>\n"
    "      </PointData>\n"
    "      <CellData>\n"
    "      </CellData>\n"
    "    </Piece>\n"
    "  </ImageData>\n"
    "  <AppendedData encoding=\"raw\">\n"
    "   "
    "_\002\000\000\000\020\000\000\000\010\000\000\000\030\000\000\000\020\000\000\000x^c``d`b`f`a`e`c`"
    "g\000\000\000\270\000\035x^\343`\340d\340b\340f\000\000\000\274\000'\n"
    "  </AppendedData>\n"
    "</VTKFile>\n",
    738);

inline const std::string kVtkRawWideBigEndian(
    "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"BigEndian\" header_type=\"UInt64\">\n"
    "  <ImageData WholeExtent=\"1 3 -1 0 4 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 4\" Direction=\"0 -1 0 1 0 0 0 0 "
    "1\">\n"
    "    <Piece Extent=\"1 3 -1 0 4 5\"                                                      >\n"
    "      <PointData Scalars=\"ramp\">\n"
    "        <DataArray type=\"Int16\" Name=\"ramp\" format=\"appended\" RangeMin=\"0\"                    "
    "RangeMax=\"11\"                   offset=\"0\"                   >\n"
    "        </DataArray>\n"
    "      </PointData>\n"
    "      <CellData>\n"
    "      </CellData>\n"
    "    </Piece>\n"
    "  </ImageData>\n"
    "  <AppendedData encoding=\"raw\">\n"
    "   "
    "_\000\000\000\000\000\000\000\030\000\000\000\001\000\002\000\003\000\004\000\005\000\006\000\007\000\010\000\011"
    "\000\n"
    "\000\013\n"
    "  </AppendedData>\n"
    "</VTKFile>\n",
    672);

inline const std::string kVtkAppendedBase64(
    "<\?xml version=\"1.0\"\?>\n"
    "<VTKFile type=\"ImageData\" version=\"0.1\" byte_order=\"LittleEndian\" header_type=\"UInt32\">\n"
    "  <ImageData WholeExtent=\"1 3 -1 0 4 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 4\" Direction=\"0 -1 0 1 0 0 0 0 "
    "1\">\n"
    "    <Piece Extent=\"1 3 -1 0 4 5\"                                                      >\n"
    "      <PointData Scalars=\"ramp\">\n"
    "        <DataArray type=\"Int16\" Name=\"ramp\" format=\"appended\" RangeMin=\"0\"                    "
    "RangeMax=\"11\"                   offset=\"0\"                   >\n"
    "        </DataArray>\n"
    "      </PointData>\n"
    "      <CellData>\n"
    "      </CellData>\n"
    "    </Piece>\n"
    "  </ImageData>\n"
    "  <AppendedData encoding=\"base64\">\n"
    "   _GAAAAAAAAQACAAMABAAFAAYABwAIAAkACgALAA==\n"
    "  </AppendedData>\n"
    "</VTKFile>\n",
    708);

inline const std::string kVtkAppendedBase64ZlibWideBigEndian(
    "<\?xml version=\"1.0\"\?>\n"
    "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"BigEndian\" header_type=\"UInt64\" "
    "compressor=\"vtkZLibDataCompressor\">\n"
    "  <ImageData WholeExtent=\"1 3 -1 0 4 5\" Origin=\"10 20 30\" Spacing=\"0.5 2 4\" Direction=\"0 -1 0 1 0 0 0 0 "
    "1\">\n"
    "    <Piece Extent=\"1 3 -1 0 4 5\"                                                      >\n"
    "      <PointData Scalars=\"ramp\">\n"
    "        <DataArray type=\"Int16\" Name=\"ramp\" format=\"appended\" RangeMin=\"0\"                    "
    "RangeMax=\"11\"                   offset=\"0\"                   >\n"
    "        </DataArray>\n"
    "      </PointData>\n"
    "      <CellData>\n"
    "      </CellData>\n"
    "    </Piece>\n"
    "  </ImageData>\n"
    "  <AppendedData encoding=\"base64\">\n"
    "   _AAAAAAAAAAEAAAAAAACAAAAAAAAAAAAYAAAAAAAAAB0=eF4FwQcBADAIACB07vfvKyCkoUzLdlzPbwISAEM=\n"
    "  </AppendedData>\n"
    "</VTKFile>\n",
    784);

}  // namespace isolux::test
