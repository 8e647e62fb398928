# The rooms of core, from the lowest up, and what each may use: those before it. The test
# Layering and doc/architecture.md have the same table.
robot_tissue_room(base
  PUBLIC carriers.h compat.h contact_set.h deadline.h disjoint_sets.h golden_section.h grid_box.h part_of_way.h robot_pose.h
    same_bits.h shared_const.h sparse_values.h types.h
  FILES steady_numbers.h text_of.h)
robot_tissue_room(simd
  USES base
  FILES field_kernel.cpp field_kernel.h lanes.h numbers.h sum_of_terms.h
    symmetric_kernel.cpp symmetric_kernel.h vector_clones.h vectors.h workers.cpp workers.h)
robot_tissue_room(geometry
  USES base
  PUBLIC cell_fill.h grid.h mesh_checks.h mesh_walls.h triangle_mesh.h triangle_point.h vertex_triangles.h
  FILES bent_grid.h cell_fill.cpp connected_triangles.cpp connected_triangles.h exact_points.cpp exact_points.h grid.cpp index_hash.h mesh_checks.cpp mesh_columns.cpp
    mesh_columns.h mesh_pieces.cpp mesh_pieces.h mesh_points.cpp mesh_points.h mesh_refinement.cpp mesh_slicing.cpp
    mesh_slicing.h mesh_walls.cpp polygon_triangles.cpp polygon_triangles.h self_intersection.cpp tetrahedron.cpp
    tetrahedron.h triangle_mesh.cpp tuning.h vertex_triangles.cpp)
robot_tissue_room(config
  USES base geometry
  PUBLIC body_load.h name_rules.h removed_space.h scene.h suture.h suture_ranges.h tool_role.h
  FILES material.cpp material.h tool_role.cpp)
robot_tissue_room(lattice
  USES base geometry config
  PUBLIC cells.h composition.h filled_grid.h lattice.h lattice_state.h
  FILES cell_reach.h cells.cpp changed_cells.cpp changed_cells.h composition.cpp connectivity.cpp
    connectivity.h filled_grid.cpp held_layers.cpp held_layers.h lattice.cpp piece_numbers.cpp
    piece_numbers.h slivers.cpp slivers.h)
robot_tissue_room(cutting
  USES base geometry config lattice
  FILES blade_surface.cpp blade_surface.h cell_division.cpp cell_division.h crumbs.cpp crumbs.h
    cut.cpp cut.h cut_front.cpp cut_front.h removal.cpp removal.h split_cells.cpp split_cells.h tear.cpp tear.h)
robot_tissue_room(surface
  USES base geometry lattice cutting
  PUBLIC curved_surface.h surface.h surface_strain.h
  FILES cell_parts.cpp cell_parts.h curved_surface.cpp cut_mesh_surface.cpp cut_mesh_surface.h cut_region.cpp cut_region.h
    divided_grid.cpp
    divided_grid.h held_surface.cpp held_surface.h hinges.cpp hinges.h mean_curvature.cpp mean_curvature.h merged_skin.cpp merged_skin.h mesh_surface.cpp
    mesh_surface.h nearest_point.cpp nearest_point.h octant_grid.cpp octant_grid.h smooth_carriers.cpp
    smooth_carriers.h smooth_part.cpp smooth_part.h surface.cpp surface_strain.cpp)
robot_tissue_room(membrane
  USES base simd geometry config surface
  FILES bending_parts.cpp bending_parts.h hinge.cpp hinge.h membrane.cpp membrane.h
    membrane_plan.cpp membrane_plan.h node_blocks.cpp node_blocks.h pressed_triangle.cpp
    pressed_triangle.h row_kernel.cpp row_kernel.h sheet_kernel.cpp sheet_kernel.h sheet_law.cpp sheet_law.h stretched_triangle.cpp stretched_triangle.h
    vertex_carriers.cpp vertex_carriers.h)
robot_tissue_room(material
  USES base config lattice membrane
  FILES cell_modes.cpp cell_modes.h elastic_cell.cpp elastic_cell.h elastic_law.h
    elastic_in_time.cpp elastic_model.cpp elastic_model.h energy_model.h fill_law.cpp fill_law.h inertial_term.h six_spring_model.cpp
    six_spring_model.h reached_displacements.h tissue_model.h viscosity.h)
robot_tissue_room(loads
  USES base config geometry lattice material
  PUBLIC contact_spring.h contact_update.h indenter.h loading_patch.h narrow_contact.h solve_report.h
  FILES bed_columns.cpp bed_columns.h constrained_state.cpp constrained_state.h contact_spring.cpp dof_constraints.cpp
    dof_constraints.h driven_places.cpp driven_places.h footprint.cpp footprint.h half_space.cpp half_space.h indenter.cpp
    loading_patch.cpp local_lattice.cpp local_lattice.h narrow_contact.cpp narrow_contact.h
    patch_bed.cpp patch_bed.h patch_rim.cpp
    patch_rim.h point_loads.cpp point_loads.h ratio_table.h rim_law.cpp rim_law.h solve_report.cpp suture_thread.cpp suture_thread.h
    tool_bed.cpp tool_bed.h)
robot_tissue_room(saving
  USES base config lattice cutting loads
  FILES bytes.h checked_values.cpp checked_values.h saved_lattice.cpp saved_lattice.h saved_loads.cpp saved_loads.h saved_pieces.cpp
    saved_pieces.h saved_state.cpp saved_state.h saved_sutures.cpp saved_sutures.h)
robot_tissue_room(solvers
  USES base lattice loads
  FILES solve_clock.h solver_method.h)
# Alone: members of a template that constrained_nodes.cpp instantiates as a whole, which Clang
# refuses to do twice in one file.
set_source_files_properties(src/core/solvers/multigrid/level/constrained_balance.cpp
  PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
robot_tissue_room(solvers/multigrid/level
  USES base simd lattice membrane material loads
  FILES cell_barrier.h cell_block.h cell_kernel.cpp cell_kernel.h cell_operator.cpp cell_operator.h
    cell_relief.cpp cell_relief.h cell_strain.h
  filled_block.h
    conjugate_gradients.h constrained_balance.cpp constrained_nodes.cpp constrained_nodes.h grid_level.cpp grid_level.h lattice_coarsening.cpp lattice_coarsening.h
    group_inverse.cpp group_inverse.h level_cell.cpp level_cell.h
    level_membrane.cpp level_membrane.h
    skyline_cholesky.cpp skyline_cholesky.h tuning.h woodbury_update.cpp
    woodbury_update.h)
robot_tissue_room(solvers/multigrid/hierarchy
  USES base simd lattice material loads solvers/multigrid/level
  FILES coarse_correction.cpp coarse_correction.h composite_grid.cpp composite_grid.h
    fas_restriction.cpp fas_restriction.h free_ends.cpp free_ends.h grid_hierarchy.cpp
    grid_hierarchy.h grid_transfer.cpp grid_transfer.h level_constraints.cpp level_constraints.h level_source.cpp level_source.h
    light_nodes.cpp light_nodes.h listed_cells.cpp listed_cells.h membrane_levels.cpp
    membrane_levels.h node_displacements.cpp node_displacements.h node_loads.cpp node_loads.h
    open_parts.cpp open_parts.h tuning.h uncovered_part.cpp uncovered_part.h)
robot_tissue_room(solvers/multigrid/cycle
  USES simd lattice material loads solvers solvers/multigrid/level solvers/multigrid/hierarchy
  FILES budget.h composite_shape.cpp composite_shape.h earlier_ways.cpp earlier_ways.h error_estimator.cpp error_estimator.h
    fas_cg_cycle.cpp fas_cg_cycle.h fas_cg_iteration.cpp fas_cg_iteration.h fas_cg_solver.cpp
    fas_cg_solver.h force_balance.cpp force_balance.h layered_method.cpp layered_method.h
    line_search.cpp line_search.h motion_left.h multigrid_solver.h open_part.cpp
    open_part.h patch_answers.cpp patch_answers.h solve_context.h solve_progress.cpp
    solve_progress.h trial_at_rest.cpp trial_at_rest.h tuning.h warm_start.cpp warm_start.h
    way_limits.h)
robot_tissue_room(solvers/newton
  USES lattice membrane material loads solvers
  FILES dof_map.cpp dof_map.h equilibrium.cpp equilibrium.h newton_method.cpp newton_method.h
    sparse_factor.cpp sparse_factor.h tuning.h)
robot_tissue_room(solvers/paper
  USES lattice material loads solvers
  FILES layers.cpp layers.h paper_method.cpp paper_method.h)
robot_tissue_room(solvers/baselines/kernels
  USES simd lattice material
  FILES colored_layout.cpp colored_layout.h lane_corners.h lane_kernels.h lane_math.h
  VECTOR_LOOPS force_kernels.cpp lane_sums.cpp vbd_kernels.cpp xpbd_kernels.cpp)
robot_tissue_room(solvers/baselines
  USES base simd material loads solvers solvers/baselines/kernels
  FILES contact_passage.cpp contact_passage.h explicit_method.cpp explicit_method.h node_step.cpp node_step.h relaxation_method.cpp
    relaxation_method.h relaxation_waves.cpp soa_field.cpp soa_field.h soa_sweeps.cpp spare_arrays.h tuning.h
    vbd_method.cpp vbd_method.h xpbd_method.cpp xpbd_method.h)
robot_tissue_room(tissue
  USES base config lattice cutting surface membrane material loads saving solvers
    solvers/multigrid/cycle
    solvers/newton solvers/paper solvers/baselines
  PUBLIC load_step_bound.h method_names.h patience.h tissue.h
  FILES body.cpp body.h contact_rounds.cpp front_ties.cpp front_ties.h history.cpp history.h kept_still.cpp kept_still.h
    load_program.cpp load_program.h load_ramp.h load_starts.cpp load_step_bound.cpp load_step_solver.cpp load_step_solver.h
    load_stepping.cpp load_stepping.h method_pair.cpp method_pair.h partings.h patience.cpp
    piece_registry.cpp piece_registry.h pressed_surfaces.cpp pressed_surfaces.h refused_patch.h registry.cpp registry.h relaxed_pieces.cpp removals.cpp round_gain.h solve_bounds.cpp
    solve_bounds.h solve_outcome.h solve_total.h standing_loads.cpp standing_loads.h surgery.cpp surgery.h
    suturing.cpp suturing.h tearing.cpp threads.cpp threads.h time_integrator.cpp time_integrator.h
    time_stepping.cpp time_stepping.h tissue.cpp tissue_data.cpp tissue_data.h tissue_forces.cpp
    tissue_forces.h tissue_motion.cpp tissue_motion.h tissue_parts.h tissue_states.cpp tissue_states.h
    topology_change.h tuning.h)
