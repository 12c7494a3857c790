! The C interface of Needlework for Fortran 2018: all functions of needlework.h, which says what each
! of them does. What is NULL in C is left out here, or c_null_ptr.
!
!     gfortran needlework.f90 PROGRAM.f90 $(pkg-config --libs needlework)
module needlework
  use, intrinsic :: iso_c_binding
  implicit none

  integer(c_int), parameter :: needlework_ok = 0, needlework_usage = 2, needlework_input = 3, &
                               needlework_invalid_state = 4, needlework_io = 5
  integer(c_int), parameter :: needlework_replace = 1
  integer(c_int), parameter :: needlework_stop_time = 0, needlework_stop_collisions = 1, &
                               needlework_stop_energy = 2, needlework_stop_wall_time = 3, &
                               needlework_stop_interrupted = 4, &
                               needlework_stop_nothing_can_happen = 5, &
                               needlework_stop_walls_meet = 6, needlework_stop_jammed = 7, &
                               needlework_stop_grown = 8, needlework_stop_pressure = 9, &
                               needlework_stop_no_room = 10
  ! Of needlework_happening; 255 is -1 in Fortran, whose bytes have a sign.
  integer(c_int8_t), parameter :: needlework_kind_pair = 0, needlework_kind_wall = 1, &
                                  needlework_kind_contact_entered = 2, &
                                  needlework_kind_contact_ended = 3, &
                                  needlework_kind_thermostat = 4, needlework_kind_other = -1
  integer(c_int), parameter :: needlework_data_bytes = 0, needlework_data_json = 1

  type, bind(c) :: needlework_error
    integer(c_int) :: code = 0
    character(kind=c_char) :: message(1024) = c_null_char
  end type

  ! Made by rows_of() or columns_of(). Serves as needlework_const_vectors as well.
  type, bind(c) :: needlework_vectors
    type(c_ptr) :: data = c_null_ptr
    integer(c_intptr_t) :: row = 0, column = 0
  end type

  type, bind(c) :: needlework_initial
    integer(c_size_t) :: count = 0
    real(c_double) :: box(3) = 0
    type(needlework_vectors) :: position, velocity, orientation, angular_velocity
    type(c_ptr) :: id = c_null_ptr
    type(needlework_vectors) :: peculiar_velocity
    real(c_double) :: slide = 0, low(3) = 0
  end type

  type, bind(c) :: needlework_bodies
    type(c_ptr) :: length = c_null_ptr, diameter = c_null_ptr, mass = c_null_ptr, &
      inertia = c_null_ptr
  end type

  type, bind(c) :: needlework_state
    type(needlework_vectors) :: position, velocity, orientation, angular_velocity
    type(c_ptr) :: image = c_null_ptr, id = c_null_ptr
    type(needlework_vectors) :: peculiar_velocity
    type(c_ptr) :: slide = c_null_ptr, low = c_null_ptr
  end type

  type, bind(c) :: needlework_limits
    real(c_double) :: time = 0
    integer(c_int64_t) :: collisions = 0
    real(c_double) :: collisions_per_needle = 0, energy_ratio = 0, wall_s = 0
  end type

  type, bind(c) :: needlework_totals
    ! numbers of totals_in_c
    real(c_double) :: time
    real(c_double) :: t_tr
    real(c_double) :: t_rot
    real(c_double) :: energy
    real(c_double) :: initial_energy
    real(c_double) :: momentum(3)
    integer(c_int64_t) :: collisions
    integer(c_int64_t) :: tc_collisions
    real(c_double) :: mean_free_time
    real(c_double) :: epoch_length
    ! end of numbers
  end type

  type, bind(c) :: needlework_species
    integer(c_int64_t) :: count
    real(c_double) :: length, mass, k, t_tr, t_rot
  end type

  type, bind(c) :: needlework_species_pair
    real(c_double) :: epsilon, beta
    integer(c_int64_t) :: collisions
  end type

  ! `horizon` is c_loc() of an array, so is `skip` where it is given (of integer(c_int8_t)), and
  ! `accuracy` that of a text which ends with c_null_char.
  type, bind(c) :: needlework_pairs
    integer(c_size_t) :: count = 0
    type(needlework_vectors) :: r1, u1, v1, w1, r2, u2, v2, w2
    type(c_ptr) :: horizon = c_null_ptr, skip = c_null_ptr, accuracy = c_null_ptr
  end type

  ! Each is c_loc() of an array, where it is given.
  type, bind(c) :: needlework_pair_sizes
    type(c_ptr) :: length1 = c_null_ptr, length2 = c_null_ptr
    type(c_ptr) :: diameter1 = c_null_ptr, diameter2 = c_null_ptr
  end type

  type, bind(c) :: needlework_rods
    ! numbers of rods
    real(c_double) :: packing_fraction
    real(c_double) :: virial
    real(c_double) :: pressure
    ! end of numbers
  end type

  type, bind(c) :: needlework_gas
    real(c_double) :: k = 6, epsilon = 1, beta = -1
  end type

  type, bind(c) :: needlework_state_after
    real(c_double) :: position(3), velocity(3), orientation(3), angular_velocity(3)
  end type

  type, bind(c) :: needlework_collision
    integer(c_int64_t) :: epoch
    real(c_double) :: offset, time
    integer(c_int32_t) :: first, second, shift(3)
    real(c_double) :: arm_first, arm_second, sin_angle, normal_velocity, impulse(3), energy_change
    integer(c_int8_t) :: contact_time_rule
    type(needlework_state_after) :: after(2)
  end type

  type, bind(c) :: needlework_happening
    integer(c_int8_t) :: kind, source
    type(needlework_collision) :: event
  end type

  type, bind(c) :: needlework_wall
    integer(c_int) :: axis, high
    ! numbers of walls
    integer(c_int64_t) :: hits
    real(c_double) :: impulse
    real(c_double) :: normal_impulse
    real(c_double) :: area
    real(c_double) :: phase
    real(c_double) :: energy
    real(c_double) :: pressure
    real(c_double) :: place
    real(c_double) :: work
    real(c_double) :: impulse_x
    real(c_double) :: impulse_y
    real(c_double) :: impulse_z
    ! end of numbers
  end type

  type, bind(c) :: needlework_pressure_tensor
    ! numbers of pressure_tensor
    real(c_double) :: kinetic_xx
    real(c_double) :: kinetic_xy
    real(c_double) :: kinetic_xz
    real(c_double) :: kinetic_yx
    real(c_double) :: kinetic_yy
    real(c_double) :: kinetic_yz
    real(c_double) :: kinetic_zx
    real(c_double) :: kinetic_zy
    real(c_double) :: kinetic_zz
    real(c_double) :: collisional_xx
    real(c_double) :: collisional_xy
    real(c_double) :: collisional_xz
    real(c_double) :: collisional_yx
    real(c_double) :: collisional_yy
    real(c_double) :: collisional_yz
    real(c_double) :: collisional_zx
    real(c_double) :: collisional_zy
    real(c_double) :: collisional_zz
    real(c_double) :: shear_stress
    real(c_double) :: shear_stress_error
    real(c_double) :: viscosity
    real(c_double) :: viscosity_error
    real(c_double) :: first_normal_difference
    real(c_double) :: first_normal_difference_error
    real(c_double) :: second_normal_difference
    real(c_double) :: second_normal_difference_error
    ! end of numbers
  end type

  type, bind(c) :: needlework_contacts
    ! numbers of contacts
    integer(c_int64_t) :: entered
    integer(c_int64_t) :: ended_by_force
    integer(c_int64_t) :: ended_by_tip
    integer(c_int64_t) :: ended_by_strike
    integer(c_int64_t) :: crowded
    real(c_double) :: time
    real(c_double) :: share
    ! end of numbers
  end type

  type, bind(c) :: needlework_growth
    ! numbers of growth
    real(c_double) :: scale
    real(c_double) :: rate
    real(c_double) :: packing_fraction
    real(c_double) :: pressure
    ! end of numbers
  end type

  type, bind(c) :: needlework_energy_budget
    ! numbers of energy_budget
    real(c_double) :: pairs
    real(c_double) :: walls
    real(c_double) :: thermostat
    real(c_double) :: kicks
    real(c_double) :: velocities_set
    real(c_double) :: gravity
    real(c_double) :: shear
    real(c_double) :: growth
    real(c_double) :: cooling
    ! end of numbers
  end type

  abstract interface
    integer(c_int) function needlework_on_collisions(collisions, count, user) bind(c)
      import :: needlework_collision, c_size_t, c_ptr, c_int
      integer(c_size_t), value :: count
      type(needlework_collision), intent(in) :: collisions(count)
      type(c_ptr), value :: user
    end function

    integer(c_int) function needlework_on_happenings(happenings, count, user) bind(c)
      import :: needlework_happening, c_size_t, c_ptr, c_int
      integer(c_size_t), value :: count
      type(needlework_happening), intent(in) :: happenings(count)
      type(c_ptr), value :: user
    end function
  end interface

  interface
    ! See needlework_text().
    type(c_ptr) function needlework_version() bind(c)
      import :: c_ptr
    end function

    ! `capability` ends with c_null_char.
    integer(c_int) function needlework_has(capability) bind(c)
      import :: c_int, c_char
      character(kind=c_char), intent(in) :: capability(*)
    end function

    ! `path`, a scene file, ends with c_null_char. The result is a null pointer on failure.
    type(c_ptr) function needlework_open(path, flags, error) bind(c)
      import :: c_ptr, c_char, c_int, needlework_error
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: flags
      type(needlework_error), intent(out), optional :: error
    end function

    ! `scene` ends with c_null_char. The result is a null pointer on failure.
    type(c_ptr) function needlework_create(scene, flags, error) bind(c)
      import :: c_ptr, c_char, c_int, needlework_error
      character(kind=c_char), intent(in) :: scene(*)
      integer(c_int), value :: flags
      type(needlework_error), intent(out), optional :: error
    end function

    type(c_ptr) function needlework_create_from(scene, initial, flags, error) bind(c)
      import :: c_ptr, c_char, c_int, needlework_error, needlework_initial
      character(kind=c_char), intent(in) :: scene(*)
      type(needlework_initial), intent(in) :: initial
      integer(c_int), value :: flags
      type(needlework_error), intent(out), optional :: error
    end function

    ! `image` has three numbers for each needle, image(3, N). Without them they count from 0.
    type(c_ptr) function needlework_create_with_images(scene, initial, image, flags, error) bind(c)
      import :: c_ptr, c_char, c_int, c_int32_t, needlework_error, needlework_initial
      character(kind=c_char), intent(in) :: scene(*)
      type(needlework_initial), intent(in) :: initial
      integer(c_int32_t), intent(in), optional :: image(3, *)
      integer(c_int), value :: flags
      type(needlework_error), intent(out), optional :: error
    end function

    ! `species` has one number for each needle, from 0.
    type(c_ptr) function needlework_create_with_species(scene, initial, image, species, flags, &
        error) bind(c)
      import :: c_ptr, c_char, c_int, c_int8_t, c_int32_t, needlework_error, needlework_initial
      character(kind=c_char), intent(in) :: scene(*)
      type(needlework_initial), intent(in) :: initial
      integer(c_int32_t), intent(in), optional :: image(3, *)
      integer(c_int8_t), intent(in), optional :: species(*)
      integer(c_int), value :: flags
      type(needlework_error), intent(out), optional :: error
    end function

    ! Members of `bodies` are c_loc() of arrays with one number for each needle, or c_null_ptr.
    type(c_ptr) function needlework_create_with_bodies(scene, initial, image, species, bodies, &
        flags, error) bind(c)
      import :: c_ptr, c_char, c_int, c_int8_t, c_int32_t, needlework_error, needlework_initial, &
        needlework_bodies
      character(kind=c_char), intent(in) :: scene(*)
      type(needlework_initial), intent(in) :: initial
      integer(c_int32_t), intent(in), optional :: image(3, *)
      integer(c_int8_t), intent(in), optional :: species(*)
      type(needlework_bodies), intent(in), optional :: bodies
      integer(c_int), value :: flags
      type(needlework_error), intent(out), optional :: error
    end function

    ! `file`, an output file, ends with c_null_char. The result is a null pointer on failure.
    type(c_ptr) function needlework_resume(file, error) bind(c)
      import :: c_ptr, c_char, needlework_error
      character(kind=c_char), intent(in) :: file(*)
      type(needlework_error), intent(out), optional :: error
    end function

    subroutine needlework_destroy(simulation) bind(c)
      import :: c_ptr
      type(c_ptr), value :: simulation
    end subroutine

    ! See needlework_text().
    type(c_ptr) function needlework_message(simulation) bind(c)
      import :: c_ptr
      type(c_ptr), value :: simulation
    end function

    ! Without limits, the scene's [until] counts.
    integer(c_int) function needlework_run_until(simulation, limits, stop) bind(c)
      import :: c_ptr, c_int, needlework_limits
      type(c_ptr), value :: simulation
      type(needlework_limits), intent(in), optional :: limits
      integer(c_int), intent(inout), optional :: stop
    end function

    integer(c_int) function needlework_advance(simulation, limits, stop) bind(c)
      import :: c_ptr, c_int, needlework_limits
      type(c_ptr), value :: simulation
      type(needlework_limits), intent(in) :: limits
      integer(c_int), intent(inout), optional :: stop
    end function

    subroutine needlework_interrupt(simulation) bind(c)
      import :: c_ptr
      type(c_ptr), value :: simulation
    end subroutine

    integer(c_int) function needlework_checkpoint(simulation) bind(c)
      import :: c_ptr, c_int
      type(c_ptr), value :: simulation
    end function

    integer(c_int) function needlework_close(simulation) bind(c)
      import :: c_ptr, c_int
      type(c_ptr), value :: simulation
    end function

    ! `callback` is c_funloc() of a function like needlework_on_collisions.
    integer(c_int) function needlework_set_callback(simulation, batch, callback, user) bind(c)
      import :: c_ptr, c_int, c_size_t, c_funptr
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: batch
      type(c_funptr), value :: callback
      type(c_ptr), value :: user
    end function

    ! `callback` is c_funloc() of a function like needlework_on_happenings.
    integer(c_int) function needlework_set_happening_callback(simulation, batch, callback, user) &
        bind(c)
      import :: c_ptr, c_int, c_size_t, c_funptr
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: batch
      type(c_funptr), value :: callback
      type(c_ptr), value :: user
    end function

    integer(c_size_t) function needlework_wall_count(simulation) bind(c)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: simulation
    end function

    integer(c_int) function needlework_get_wall(simulation, index, wall) bind(c)
      import :: c_ptr, c_int, c_size_t, needlework_wall
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: index
      type(needlework_wall), intent(out) :: wall
    end function

    integer(c_int) function needlework_get_contacts(simulation, contacts) bind(c)
      import :: c_ptr, c_int, needlework_contacts
      type(c_ptr), value :: simulation
      type(needlework_contacts), intent(out) :: contacts
    end function

    integer(c_int) function needlework_get_growth(simulation, growth) bind(c)
      import :: c_ptr, c_int, needlework_growth
      type(c_ptr), value :: simulation
      type(needlework_growth), intent(out) :: growth
    end function

    integer(c_int) function needlework_get_pressure_tensor(simulation, tensor) bind(c)
      import :: c_ptr, c_int, needlework_pressure_tensor
      type(c_ptr), value :: simulation
      type(needlework_pressure_tensor), intent(out) :: tensor
    end function

    integer(c_int) function needlework_get_energy_budget(simulation, budget) bind(c)
      import :: c_ptr, c_int, needlework_energy_budget
      type(c_ptr), value :: simulation
      type(needlework_energy_budget), intent(out) :: budget
    end function

    integer(c_size_t) function needlework_count(simulation) bind(c)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: simulation
    end function

    integer(c_int) function needlework_get_box(simulation, box) bind(c)
      import :: c_ptr, c_int, c_double
      type(c_ptr), value :: simulation
      real(c_double), intent(inout) :: box(3)
    end function

    integer(c_int) function needlework_get_state(simulation, into) bind(c)
      import :: c_ptr, c_int, needlework_state
      type(c_ptr), value :: simulation
      type(needlework_state), intent(in) :: into
    end function

    integer(c_int) function needlework_write_state(simulation, path, flags) bind(c)
      import :: c_ptr, c_char, c_int
      type(c_ptr), value :: simulation
      character(kind=c_char), intent(in) :: path(*)
      integer(c_int), value :: flags
    end function

    integer(c_int) function needlework_set_velocities(simulation, velocity, angular_velocity) &
        bind(c)
      import :: c_ptr, c_int, needlework_vectors
      type(c_ptr), value :: simulation
      type(needlework_vectors), intent(in) :: velocity
      type(needlework_vectors), intent(in), optional :: angular_velocity
    end function

    integer(c_int) function needlework_sample(simulation, frame) bind(c)
      import :: c_ptr, c_int
      type(c_ptr), value :: simulation
      integer(c_int), value :: frame
    end function

    ! `index` counts from 0; a null pointer behind the last. See needlework_text().
    type(c_ptr) function needlework_species_name(simulation, index) bind(c)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: index
    end function

    ! Indices of species count from 0.
    integer(c_int) function needlework_get_species(simulation, index, species) bind(c)
      import :: c_ptr, c_int, c_size_t, needlework_species
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: index
      type(needlework_species), intent(inout) :: species
    end function

    integer(c_int) function needlework_get_species_pair(simulation, first, second, pair) bind(c)
      import :: c_ptr, c_int, c_size_t, needlework_species_pair
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: first, second
      type(needlework_species_pair), intent(inout) :: pair
    end function

    ! `meet` is 1, or 0 where needles of the two pass through each other.
    integer(c_int) function needlework_species_meet(simulation, first, second, meet) bind(c)
      import :: c_ptr, c_int, c_size_t
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: first, second
      integer(c_int), intent(inout) :: meet
    end function

    integer(c_int) function needlework_get_species_of_needles(simulation, species) bind(c)
      import :: c_ptr, c_int, c_int8_t
      type(c_ptr), value :: simulation
      integer(c_int8_t), intent(inout) :: species(*)
    end function

    integer(c_int) function needlework_get_bodies(simulation, length, diameter, mass, inertia) bind(c)
      import :: c_ptr, c_int, c_double
      type(c_ptr), value :: simulation
      real(c_double), intent(inout), optional :: length(*), diameter(*), mass(*), inertia(*)
    end function

    ! `name` ends with c_null_char. `data` is c_loc() of `size` bytes, or c_null_ptr.
    integer(c_int) function needlework_set_data(simulation, name, kind, data, size) bind(c)
      import :: c_ptr, c_int, c_char, c_size_t
      type(c_ptr), value :: simulation
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int), value :: kind
      type(c_ptr), value :: data
      integer(c_size_t), value :: size
    end function

    integer(c_int) function needlework_get_data(simulation, name, kind, data, capacity, size) &
        bind(c)
      import :: c_ptr, c_int, c_char, c_size_t
      type(c_ptr), value :: simulation
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int), intent(inout), optional :: kind
      type(c_ptr), value :: data
      integer(c_size_t), value :: capacity
      integer(c_size_t), intent(inout), optional :: size
    end function

    ! `index` counts from 0; a null pointer behind the last. See needlework_text().
    type(c_ptr) function needlework_data_name(simulation, index) bind(c)
      import :: c_ptr, c_size_t
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: index
    end function

    integer(c_int) function needlework_get_totals(simulation, totals) bind(c)
      import :: c_ptr, c_int, needlework_totals
      type(c_ptr), value :: simulation
      type(needlework_totals), intent(inout) :: totals
    end function

    integer(c_int) function needlework_get_hash(simulation, hash) bind(c)
      import :: c_ptr, c_int, c_char
      type(c_ptr), value :: simulation
      character(kind=c_char), intent(inout) :: hash(33)
    end function

    ! `index` counts from 0; a null pointer behind the last. See needlework_text().
    type(c_ptr) function needlework_counter_name(index) bind(c)
      import :: c_ptr, c_size_t
      integer(c_size_t), value :: index
    end function

    ! `name` ends with c_null_char.
    integer(c_int) function needlework_get_counter(simulation, name, value) bind(c)
      import :: c_ptr, c_int, c_char, c_int64_t
      type(c_ptr), value :: simulation
      character(kind=c_char), intent(in) :: name(*)
      integer(c_int64_t), intent(inout) :: value
    end function

    ! `name` ends with c_null_char. See needlework_text().
    type(c_ptr) function needlework_setting(simulation, name) bind(c)
      import :: c_ptr, c_char
      type(c_ptr), value :: simulation
      character(kind=c_char), intent(in) :: name(*)
    end function

    integer(c_int) function needlework_predict(pairs, time, s12, s21, error) bind(c)
      import :: c_int, c_double, needlework_pairs, needlework_error
      type(needlework_pairs), intent(in) :: pairs
      real(c_double), intent(inout), optional :: time(*), s12(*), s21(*)
      type(needlework_error), intent(out), optional :: error
    end function

    integer(c_int) function needlework_predict_with_sizes(pairs, sizes, time, s12, s21, error) &
        bind(c)
      import :: c_int, c_double, needlework_pairs, needlework_pair_sizes, needlework_error
      type(needlework_pairs), intent(in) :: pairs
      type(needlework_pair_sizes), intent(in), optional :: sizes
      real(c_double), intent(inout), optional :: time(*), s12(*), s21(*)
      type(needlework_error), intent(out), optional :: error
    end function

    integer(c_int) function needlework_get_rods(simulation, rods) bind(c)
      import :: c_ptr, c_int, needlework_rods
      type(c_ptr), value :: simulation
      type(needlework_rods), intent(inout) :: rods
    end function

    ! `index` counts from 0.
    integer(c_int) function needlework_get_species_shape(simulation, index, diameter, inertia) &
        bind(c)
      import :: c_ptr, c_int, c_double, c_size_t
      type(c_ptr), value :: simulation
      integer(c_size_t), value :: index
      real(c_double), intent(inout), optional :: diameter, inertia
    end function

    integer(c_int) function needlework_ratio(gas, ratio, error) bind(c)
      import :: c_int, c_double, needlework_gas, needlework_error
      type(needlework_gas), intent(in) :: gas
      real(c_double), intent(inout) :: ratio
      type(needlework_error), intent(out), optional :: error
    end function

    integer(c_int) function needlework_cooling(gas, t_tr0, t_rot0, count, tau, t_tr, t_rot, error) &
        bind(c)
      import :: c_int, c_double, c_size_t, needlework_gas, needlework_error
      type(needlework_gas), intent(in) :: gas
      real(c_double), value :: t_tr0, t_rot0
      integer(c_size_t), value :: count
      real(c_double), intent(in) :: tau(*)
      real(c_double), intent(inout), optional :: t_tr(*), t_rot(*)
      type(needlework_error), intent(out), optional :: error
    end function

    integer(c_int) function needlework_collision_rate(k, density, t_tr, t_rot, rate, error) bind(c)
      import :: c_int, c_double, needlework_error
      real(c_double), value :: k, density, t_tr, t_rot
      real(c_double), intent(inout) :: rate
      type(needlework_error), intent(out), optional :: error
    end function
  end interface

contains

  ! An array a(3, N), one column for each needle. Must have the attribute target where it is
  ! declared.
  function rows_of(a) result(vectors)
    real(c_double), intent(in), target, contiguous :: a(:, :)
    type(needlework_vectors) :: vectors
    if (size(a) > 0) vectors%data = c_loc(a)
    vectors%row = 3
    vectors%column = 1
  end function

  ! An array a(N, 3), one row for each needle.
  function columns_of(a) result(vectors)
    real(c_double), intent(in), target, contiguous :: a(:, :)
    type(needlework_vectors) :: vectors
    if (size(a) > 0) vectors%data = c_loc(a)
    vectors%row = 1
    vectors%column = size(a, 1)
  end function

  ! The text that a string of C holds.
  function needlework_text(string) result(text)
    type(c_ptr), intent(in) :: string
    character(len=:), allocatable :: text
    character(kind=c_char), pointer :: characters(:)
    integer :: length
    call c_f_pointer(string, characters, [4096])
    length = 0
    do while (characters(length + 1) /= c_null_char)
      length = length + 1
    end do
    text = text_of(characters(:length))
  end function

  ! The text of an array of characters, up to the first c_null_char.
  function text_of(characters) result(text)
    character(kind=c_char), intent(in) :: characters(:)
    character(len=:), allocatable :: text
    integer :: n
    text = ''
    do n = 1, size(characters)
      if (characters(n) == c_null_char) exit
      text = text // characters(n)
    end do
  end function
end module
