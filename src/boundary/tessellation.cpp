#include "boundary/tessellation.hpp"

#include <CGAL/Delaunay_triangulation_2.h>
#include <CGAL/Delaunay_triangulation_3.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Triangulation_cell_base_with_info_3.h>
#include <CGAL/Triangulation_face_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_2.h>
#include <CGAL/Triangulation_vertex_base_with_info_3.h>

#include <utility>

namespace eg {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Plane = CGAL::Delaunay_triangulation_2<
    Kernel, CGAL::Triangulation_data_structure_2<CGAL::Triangulation_vertex_base_with_info_2<Index, Kernel>,
                                                 CGAL::Triangulation_face_base_with_info_2<Index, Kernel>>>;
using Space = CGAL::Delaunay_triangulation_3<
    Kernel,
    CGAL::Triangulation_data_structure_3<
        CGAL::Triangulation_vertex_base_with_info_3<Index, Kernel>,
        CGAL::Delaunay_triangulation_cell_base_3<Kernel, CGAL::Triangulation_cell_base_with_info_3<Index, Kernel>>>>;

/// `cells`: range of handles of all cells, those at infinity too.
template <class Mesh, class Cells>
Tessellation tessellation_of(const Mesh& mesh, const Cells& cells, int corners) {
  mesh.infinite_vertex()->info() = no_index;
  Index count = 0;
  for (const auto& cell : cells) cell->info() = count++;
  Tessellation out;
  out.corners.resize(count), out.neighbours.resize(count);
  for (const auto& cell : cells)
    for (int k = 0; k < corners; ++k) {
      const auto slot = static_cast<std::size_t>(k);
      out.corners[cell->info()][slot] = cell->vertex(k)->info();
      out.neighbours[cell->info()][slot] = cell->neighbor(k)->info();
    }
  return out;
}

}  // namespace

Tessellation delaunay(int dimension, const std::vector<Vec3>& points) {
  if (dimension == 2) {
    std::vector<std::pair<Kernel::Point_2, Index>> numbered;
    for (const Vec3& x : points) numbered.push_back({{x.x, x.y}, static_cast<Index>(numbered.size())});
    const Plane mesh(numbered.begin(), numbered.end());
    return mesh.dimension() < 2 ? Tessellation{} : tessellation_of(mesh, mesh.all_face_handles(), 3);
  }
  std::vector<std::pair<Kernel::Point_3, Index>> numbered;
  for (const Vec3& x : points) numbered.push_back({{x.x, x.y, x.z}, static_cast<Index>(numbered.size())});
  const Space mesh(numbered.begin(), numbered.end());
  return mesh.dimension() < 3 ? Tessellation{} : tessellation_of(mesh, mesh.all_cell_handles(), 4);
}

}  // namespace eg
