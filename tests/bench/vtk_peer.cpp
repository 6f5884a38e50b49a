#include <vtkCellArray.h>
#include <vtkImageStencilData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataToImageStencil.h>
#include <vtkSmartPointer.h>

#include <glm/vec3.hpp>

#include "tests/bench/peer.h"

namespace xorvox::bench {
namespace {

vtkSmartPointer<vtkPolyData> poly_data(const MeshView& mesh) {
    const auto points = vtkSmartPointer<vtkPoints>::New();
    points->SetDataTypeToDouble();
    for (const glm::dvec3& p : mesh.positions) points->InsertNextPoint(p.x, p.y, p.z);
    const auto triangles = vtkSmartPointer<vtkCellArray>::New();
    const auto indices = mesh.used_indices();
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const vtkIdType corners[] = {indices[i], indices[i + 1], indices[i + 2]};
        triangles->InsertNextCell(3, corners);
    }
    const auto data = vtkSmartPointer<vtkPolyData>::New();
    data->SetPoints(points);
    data->SetPolys(triangles);
    return data;
}

}  // namespace

Peer make_vtk_peer(const MeshView& mesh, const Lattice& lattice) {
    const glm::dvec3 first = sample_position(lattice, 0, 0, 0);
    const glm::ivec3 last(lattice.nx - 1, lattice.ny - 1, lattice.nz - 1);
    const auto stencil = vtkSmartPointer<vtkPolyDataToImageStencil>::New();
    stencil->SetInputData(poly_data(mesh));
    stencil->SetTolerance(0.0);
    stencil->SetOutputOrigin(first.x, first.y, first.z);
    stencil->SetOutputSpacing(lattice.pitch.x, lattice.pitch.y, lattice.pitch.z);
    stencil->SetOutputWholeExtent(0, last.x, 0, last.y, 0, last.z);

    const auto voxels = [stencil, last] {
        BitVolume volume(static_cast<std::uint32_t>(last.x) + 1, static_cast<std::uint32_t>(last.y) + 1,
                         static_cast<std::uint32_t>(last.z) + 1);
        vtkImageStencilData* const runs = stencil->GetOutput();
        for (int z = 0; z <= last.z; ++z) {
            for (int y = 0; y <= last.y; ++y) {
                int begin = 0;
                int end = 0;
                int place = 0;
                while (runs->GetNextExtent(begin, end, 0, last.x, y, z, place) != 0) {
                    for (int x = begin; x <= end; ++x) {
                        volume.view().flip(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y),
                                           static_cast<std::uint32_t>(z));
                    }
                }
            }
        }
        return volume;
    };
    const auto run = [stencil] {
        stencil->Modified();
        stencil->Update();
    };
    return {"VTK", run, voxels};
}

}  // namespace xorvox::bench
