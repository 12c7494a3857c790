! What needlework.f90 has beside simulations from arrays: a scene in a file, data of one's own,
! counters, first contacts, theory; and all that may be left out.
program all
  use needlework
  implicit none
  type(c_ptr) :: gas
  type(needlework_limits) :: limits
  type(needlework_pairs) :: pairs
  type(needlework_pair_sizes) :: sizes
  type(needlework_rods) :: rods
  type(needlework_contacts) :: contacts
  type(needlework_growth) :: growth
  type(needlework_gas) :: theory
  type(needlework_error) :: error
  character(kind=c_char), target :: notes(4) = ['{', '"', 'a', '"'], more(2) = [':', '}']
  character(kind=c_char), target :: bytes(3) = [achar(0), achar(27), achar(10)], copy(8)
  real(c_double), target :: r1(3, 1), u1(3, 1), rest(3, 1), r2(3, 1), u2(3, 1), v2(3, 1), horizon(1)
  real(c_double), target :: length2(1), width(1), moving(3, 60) = 1
  real(c_double) :: box(3), time(1), s12(1), ratio, t_tr(2), t_rot(2), diameter, inertia
  integer(c_int64_t) :: events
  integer(c_size_t) :: length
  integer(c_int) :: stopped, kind
  integer :: unit

  print '(a, i0, i0)', 'has scalar and nonsense: ', needlework_has('isa/scalar' // c_null_char), &
    needlework_has('nonsense' // c_null_char)
  if (len(needlework_text(needlework_version())) < 5) stop 1

  open (newunit=unit, file='all.toml')
  write (unit, '(a)') 'needles = { count = 60, box = [5, 6, 7] }', 'until.collisions_per_needle = 1', &
    'output.file = "all.h5"'
  close (unit)
  gas = needlework_open('absent.toml' // c_null_char, 0_c_int)
  if (c_associated(gas)) stop 2
  gas = needlework_open('all.toml' // c_null_char, needlework_replace, error)
  if (.not. c_associated(gas)) then
    print '(a)', text_of(error%message)
    stop 3
  end if
  call require(needlework_get_box(gas, box))
  print '(a, 3f4.1)', 'box', box
  call require(needlework_run_until(gas))  ! as [until] says
  limits%collisions = 10
  call require(needlework_advance(gas, limits))
  call require(needlework_run_until(gas, stop=stopped))
  print '(a, i0)', 'stopped by ', stopped
  call require(needlework_get_counter(gas, 'events' // c_null_char, events))
  print '(a, l1)', 'events counted: ', events >= 40
  print '(a, l1)', 'counters have names: ', c_associated(needlework_counter_name(0_c_size_t))
  print '(2a)', 'effects: ', needlework_text(needlework_setting(gas, 'effects' // c_null_char))

  call require(needlework_get_rods(gas, rods))
  call require(needlework_get_species_shape(gas, 0_c_size_t, diameter, inertia))
  print '(a, 2f4.1, f7.4)', 'needles have no width', rods%packing_fraction, diameter, inertia

  call require(needlework_get_contacts(gas, contacts))
  print '(a, i0, 2f4.1)', 'contacts ', contacts%entered, contacts%time, contacts%share
  call require(needlework_get_growth(gas, growth))
  print '(a, 3f4.1)', 'growth ', growth%scale, growth%rate, growth%packing_fraction

  call require(needlework_set_velocities(gas, rows_of(moving)))
  print '(a, i0, 1x, i0)', 'kinds: ', needlework_kind_wall, needlework_kind_other

  call require(needlework_sample(gas, 1_c_int))
  call require(needlework_set_data(gas, 'bytes' // c_null_char, needlework_data_bytes, c_loc(bytes), &
                                   3_c_size_t))
  call require(needlework_get_data(gas, 'bytes' // c_null_char, kind, c_loc(copy), 8_c_size_t, length))
  print '(a, i0, 1x, i0, 1x, l1)', 'data: ', kind, length, all_equal(copy(:3), bytes)
  print '(2a)', 'named ', needlework_text(needlework_data_name(gas, 0_c_size_t))
  if (needlework_set_data(gas, 'notes' // c_null_char, needlework_data_json, c_loc(notes), 4_c_size_t) &
      /= needlework_usage) stop 4
  print '(a)', needlework_text(needlework_message(gas))
  more = ['[', ']']
  call require(needlework_set_data(gas, 'notes' // c_null_char, needlework_data_json, c_loc(more), &
                                   2_c_size_t))
  call require(needlework_set_data(gas, 'notes' // c_null_char, needlework_data_json, c_null_ptr, &
                                   0_c_size_t))
  if (c_associated(needlework_data_name(gas, 1_c_size_t))) stop 5
  call require(needlework_close(gas))
  call needlework_destroy(gas)

  r1 = 0
  rest = 0
  u1 = reshape([1, 0, 0], [3, 1])
  r2 = reshape([0.25d0, 0.125d0, 2d0], [3, 1])
  u2 = reshape([0, 1, 0], [3, 1])
  v2 = reshape([0, 0, -1], [3, 1])
  horizon = 10
  pairs = needlework_pairs(count=1, r1=rows_of(r1), u1=rows_of(u1), v1=rows_of(rest), &
    w1=rows_of(rest), r2=rows_of(r2), u2=rows_of(u2), v2=rows_of(v2), w2=rows_of(rest), &
    horizon=c_loc(horizon))
  if (needlework_predict(pairs, time, s12) /= needlework_ok) stop 6
  print '(a, 2f7.4)', 'first contact', time, s12
  length2 = 0
  width = 0.625d0
  sizes = needlework_pair_sizes(length2=c_loc(length2), diameter1=c_loc(width), diameter2=c_loc(width))
  if (needlework_predict_with_sizes(pairs, sizes, time, s12) /= needlework_ok) stop 10
  print '(a, 2f7.4)', 'of a rod and a sphere', time, s12

  theory = needlework_gas(k=6, epsilon=0.8d0, beta=-1)
  if (needlework_ratio(theory, ratio) /= needlework_ok) stop 7
  if (needlework_cooling(theory, 1d0, 0d0, 2_c_size_t, [0d0, 1d0], t_tr, t_rot) /= needlework_ok) stop 8
  print '(a, l1, 2f5.1, l1)', 'theory ', ratio > 1, t_tr(1), t_rot(1), t_rot(2) > 0

contains

  subroutine require(code)
    integer(c_int), intent(in) :: code
    if (code == needlework_ok) return
    print '(a)', needlework_text(needlework_message(gas))
    stop 9
  end subroutine

  logical function all_equal(a, b)
    character(kind=c_char), intent(in) :: a(:), b(:)
    all_equal = size(a) == size(b)
    if (all_equal) all_equal = count(a == b) == size(a)
  end function
end program
