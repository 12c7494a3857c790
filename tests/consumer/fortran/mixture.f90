! Species of needles: totals, pairs, and arrays that say which needle is of which.
program mixture
  use needlework
  implicit none
  character(len=*), parameter :: line = new_line('a')
  character(len=*), parameter :: species_text = &
    '[[species]]' // line // 'name = "short"' // line // 'length = 0.5' // line // &
    '[[species]]' // line // 'name = "long"' // line // 'mass = 4' // line
  integer, parameter :: n = 3
  real(c_double), target :: position(n, 3), velocity(n, 3), director(n, 3)
  integer(c_int8_t) :: species(n) = [1_c_int8_t, 0_c_int8_t, 1_c_int8_t], copy(n)
  type(needlework_initial) :: initial
  type(needlework_species) :: short, long
  type(needlework_species_pair) :: pair
  type(needlework_limits) :: limits
  type(needlework_error) :: error
  type(needlework_bodies) :: bodies
  real(c_double), target :: masses(n) = [4d0, 1d0, 9d0]
  real(c_double) :: lengths(n), masses_read(n)
  type(c_ptr) :: gas

  ! A long needle flies against a short one that rests; another long one rests elsewhere.
  position = reshape([1d0, 3d0, 2d0, 2.5d0, 2.5d0, 1d0, 2.5d0, 2.5d0, 4.5d0], [n, 3])
  velocity = 0
  velocity(1, 1) = 1
  director = 0
  director(1, 2) = 1
  director(2, 3) = 1
  director(3, 1) = 1
  initial%count = n
  initial%box = 5
  initial%position = columns_of(position)
  initial%velocity = columns_of(velocity)
  initial%orientation = columns_of(director)
  gas = needlework_create_with_species(species_text // c_null_char, initial, species=species, &
                                       flags=0_c_int, error=error)
  if (.not. c_associated(gas)) then
    print '(a)', text_of(error%message)
    stop 1
  end if
  limits%collisions = 1
  if (needlework_run_until(gas, limits) /= needlework_ok) stop 2
  if (needlework_get_species(gas, 0_c_size_t, short) /= needlework_ok) stop 3
  if (needlework_get_species(gas, 1_c_size_t, long) /= needlework_ok) stop 4
  print '(2a, 1x, i0, 2f6.2, f8.4)', 'species ', &
    needlework_text(needlework_species_name(gas, 0_c_size_t)), short%count, short%length, &
    short%mass, short%t_tr
  print '(2a, 1x, i0, 2f6.2, f8.4)', 'species ', &
    needlework_text(needlework_species_name(gas, 1_c_size_t)), long%count, long%length, &
    long%mass, long%t_tr
  if (c_associated(needlework_species_name(gas, 2_c_size_t))) stop 5
  if (needlework_get_species_pair(gas, 1_c_size_t, 0_c_size_t, pair) /= needlework_ok) stop 6
  print '(a, i0, 2f5.1)', 'long with short: ', pair%collisions, pair%epsilon, pair%beta
  if (needlework_get_species_of_needles(gas, copy) /= needlework_ok) stop 7
  print '(a, 3(1x, i0))', 'species of the needles', copy
  call needlework_destroy(gas)

  ! Of the long ones, each has a mass of its own.
  bodies%mass = c_loc(masses)
  gas = needlework_create_with_bodies(species_text // c_null_char, initial, species=species, &
                                      bodies=bodies, flags=0_c_int, error=error)
  if (needlework_get_bodies(gas, length=lengths, mass=masses_read) /= needlework_ok) stop 8
  print '(a, 6f5.1)', 'lengths and masses', lengths, masses_read
  call needlework_destroy(gas)
end program
