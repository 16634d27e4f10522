#pragma once

#include "simplify/task.h"

namespace tetwright {

/// True if collapsing the star's centre a onto its link point b keeps the topology of every material,
/// interface and junction curve: Lk(a) n Lk(b) = Lk(ab) in the tets closed by a point omega outside, in the
/// interface triangles with omega joined to the junction edges, and empty in the junction edges (Dey,
/// Edelsbrunner, Guha & Nekhayev 1999; Thomas & Natarajan 2011 on embedded structures).
///
/// The task holds the closed star of a; the star of b is walked by its ids and links alone, which holding b
/// allows. Needs dim(ab) = dim(a), which the caller has tested.
bool link_condition(const EditableMesh& mesh, const Star& star, std::size_t b, LocalNumbers& numbers);

}  // namespace tetwright
